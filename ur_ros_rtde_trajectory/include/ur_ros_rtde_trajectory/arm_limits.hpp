#pragma once

#include <optional>
#include <string>

#include "ur_ros_rtde_trajectory/vector.hpp"

namespace ur_ros_rtde {

/// What an arm can do at most, by its data sheet; the safety configuration of an installation may allow less.
struct ArmLimits {
  Vector6 position;  ///< rad, symmetric: -position … +position
  Vector6 velocity;  ///< rad/s
  double reach;      ///< m, from the base's centre
};

/// A model's name as tables have it: "UR8 Long" is "ur8long".
std::string normalized_model_name(const std::string & name);
/// By model, in any spelling: "ur10e", "UR10e", "UR8 Long". None for an unknown model.
std::optional<ArmLimits> arm_limits(const std::string & model);
/// The names of all models: "ur3, ur5, …".
std::string arm_models();
/// What at least one model can do: ±2 pi, and the highest velocities.
ArmLimits widest_arm_limits();
/// What every model can do: ±2 pi, and the lowest velocity of each joint. The reach is the longest: it only
/// rules out what no arm reaches.
ArmLimits common_arm_limits();

}  // namespace ur_ros_rtde
