#pragma once

#include "motion/motion.hpp"
#include "solver/jerk_solver.hpp"

namespace ur_ros_rtde::trajectory {

inline constexpr double max_stations = 50000;  // of a segment

/// Grid of a segment for a first estimate of its timing.
Grid coarse_grid(const Path & path, std::size_t first, std::size_t last);

/// Appends the time-optimal motion along pieces [first, last) of the path under velocity, acceleration and
/// jerk limits, from rest to rest. The solution may exceed the limits slightly between its stations.
/// `solver`: for the same limits; its memory is reused.
void append_jerk_limited(Motion & motion, std::size_t first, std::size_t last, const Limits & limits,
                         JerkSolver & solver);

}  // namespace ur_ros_rtde::trajectory
