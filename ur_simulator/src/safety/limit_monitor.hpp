#pragma once

#include <optional>
#include <string>

#include "kinematics/robot_model.hpp"
#include "safety/safety_limits.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// Checks the actual state against the safety limits in every cycle.
class LimitMonitor {
 public:
  LimitMonitor(const RobotModel & model, double cycle_time) : model_(model), cycle_time_(cycle_time) {}

  /// Describes the first limit that is exceeded: value, limit and remedy.
  std::optional<std::string> check(const SafetyLimits & limits, const ControllerState & state);
  /// Tolerates the present tool force after a protective stop was unlocked, until the tool is free again or
  /// the force grows.
  void tolerate_present_force();

 private:
  std::optional<std::string> check_joints(const SafetyLimits & limits, const JointState & joints) const;
  std::optional<std::string> check_force(const SafetyLimits & limits, const ControllerState & state);

  const RobotModel & model_;
  double cycle_time_;
  double filtered_force_ = 0.0;
  double tolerated_force_ = 0.0;  ///< N; force when the stop was unlocked, lowered as the force decreases
  bool tolerate_next_force_ = false;
};

}  // namespace ur_simulator
