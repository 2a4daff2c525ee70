#pragma once

#include "trajectory/motion.hpp"

namespace ur_ros_rtde::trajectory {

/// Appends the fastest motion along pieces [first, last) of the path, from rest to rest. The result obeys the
/// limits at closely spaced points; where a solver's solution exceeded one between its stations, the motion
/// is slowed down.
void parameterize_segment(Motion & motion, std::size_t first, std::size_t last, const Limits & limits);

/// Slows down the pieces from `begin` on until no limit is exceeded where verification looks.
void slow_to_limits(Motion & motion, std::size_t begin, const Limits & limits);

}  // namespace ur_ros_rtde::trajectory
