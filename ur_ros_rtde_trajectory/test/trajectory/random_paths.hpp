#pragma once

#include <random>
#include <string>
#include <vector>

#include "ur_ros_rtde_trajectory/plan.hpp"

namespace ur_ros_rtde::trajectory::test {

struct RandomPath {
  std::string kind;
  std::vector<Joints> waypoints;
  PathOptions options;
};

/// 2 to 200 waypoints: jumps across the workspace, a planner's densely sampled smooth curve, a walk of small
/// steps of different lengths, or lines with repeated and reversed waypoints; with and without blending. The
/// same for the same seed.
RandomPath random_path(unsigned seed);

/// Velocities of the UR models in turn; accelerations and jerks different in every joint.
Limits random_limits(unsigned seed, bool with_jerk);

}  // namespace ur_ros_rtde::trajectory::test
