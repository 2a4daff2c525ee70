#pragma once

#include <memory>
#include <stop_token>

#include "motion/motion.hpp"

namespace ur_ros_rtde::trajectory {

/// Computes the time-optimal motion along a path and verifies it. Returns an error for a remaining violation,
/// in particular of a position limit. After 3 s of processor time, uses what has been found. `stop` cancels.
Expected<std::shared_ptr<Motion>> parameterize_path(std::shared_ptr<const Path> path, const Limits & limits,
                                                    const std::stop_token & stop);

}  // namespace ur_ros_rtde::trajectory
