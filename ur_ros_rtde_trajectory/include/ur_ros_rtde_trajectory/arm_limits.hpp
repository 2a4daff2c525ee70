#pragma once

#include <optional>
#include <string>

#include "ur_ros_rtde_trajectory/vector.hpp"

namespace ur_ros_rtde {

/// Limits of an arm according to its data sheet. The safety configuration of an installation may be stricter.
struct ArmLimits {
  Vector6 position;  ///< rad, symmetric: -position … +position
  Vector6 velocity;  ///< rad/s
  Vector6 torque;    ///< Nm
  double reach;      ///< m, from the center of the base
};

/// Model name in lower case, without spaces, hyphens and underscores: "UR8 Long" becomes "ur8long".
std::string normalized_model_name(const std::string & name);
/// Limits of a model. The name may be in any spelling: "ur10e", "UR10e", "UR8 Long". Returns nullopt for an
/// unknown model.
std::optional<ArmLimits> arm_limits(const std::string & model);
/// Names of all models, separated by commas: "ur3, ur5, …".
std::string arm_models();
/// Limits that at least one model can reach: ±2 pi, the highest velocities and torques.
ArmLimits widest_arm_limits();
/// Limits that every model can reach: ±2 pi, the lowest velocity and torque of each joint. The reach is the
/// longest of all models, so that only positions that no arm reaches are excluded.
ArmLimits common_arm_limits();

}  // namespace ur_ros_rtde
