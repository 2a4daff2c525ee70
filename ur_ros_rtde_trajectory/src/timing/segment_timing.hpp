#pragma once

#include "motion/motion.hpp"
#include "solver/jerk_solver.hpp"

namespace ur_ros_rtde::trajectory {

/// Appends the time-optimal motion along pieces [first, last) of the path, from rest to rest. The result
/// keeps the limits at closely spaced points: the motion is slowed down where the solution exceeds a limit
/// between its stations. `solver`: for the same limits; its memory is reused.
void parameterize_segment(Motion & motion, std::size_t first, std::size_t last, const Limits & limits,
                          JerkSolver & solver);

/// Slows down the pieces from `begin` on until no limit is exceeded at the verified points.
void slow_to_limits(Motion & motion, std::size_t begin, const Limits & limits);

}  // namespace ur_ros_rtde::trajectory
