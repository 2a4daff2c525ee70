#pragma once

#include "motion/motion.hpp"

namespace ur_ros_rtde::trajectory {

/// Appends the time-optimal motion along the straight piece `piece`, from rest to rest, in closed form: up to
/// seven phases of constant jerk, or three phases of constant acceleration without a jerk limit.
void append_s_curve_profile(Motion & motion, std::size_t piece, const Limits & limits);

}  // namespace ur_ros_rtde::trajectory
