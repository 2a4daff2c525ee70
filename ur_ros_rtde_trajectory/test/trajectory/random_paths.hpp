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

/// 2 to 200 waypoints, deterministic for each seed: jumps across the workspace, the densely sampled smooth
/// curve of a planner, a walk of small steps of different lengths, or lines with repeated and reversed
/// waypoints; with and without blending.
RandomPath random_path(unsigned seed);

struct RandomPlan {
  std::vector<Joints> waypoints;
  Limits limits;
  PathOptions options;
};

/// Anything within the ranges of the action execute_trajectory, deterministic for each seed: tiny and huge
/// limits and blends, near-duplicates, reversals, lines.
RandomPlan extreme_plan(unsigned long seed);

/// Velocities of the UR models in turn; different accelerations and jerks in every joint.
Limits random_limits(unsigned seed, bool with_jerk);

}  // namespace ur_ros_rtde::trajectory::test
