#pragma once

#include <optional>
#include <string>

#include "ur_ros_rtde/sample.hpp"

namespace ur_ros_rtde {

/// What an arm can do at most, by its data sheet; the safety configuration of an installation may allow less.
struct ArmLimits {
  Vector6 position;  ///< rad, symmetric: -position … +position
  Vector6 velocity;  ///< rad/s
  double reach;      ///< m, from the base's centre
};

/// By model, in any spelling: "ur10e", "UR10e". None for an unknown model.
std::optional<ArmLimits> arm_limits(const std::string & model);
/// What holds for every model: ±2 pi, and the highest velocities.
ArmLimits widest_arm_limits();

}  // namespace ur_ros_rtde
