#pragma once

#include <optional>
#include <string>

#include "common/error_code.hpp"
#include "kinematics/robot_model.hpp"
#include "safety/safety_limits.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// Why a limit triggers a protective stop.
struct ExceededLimit {
  ErrorCode code;
  std::string description;  ///< value, limit and remedy
};

/// Checks the actual state against the safety limits in every cycle.
class LimitMonitor {
 public:
  LimitMonitor(const RobotModel & model, double cycle_time) : model_(model), cycle_time_(cycle_time) {}

  /// The first limit that is exceeded.
  std::optional<ExceededLimit> check(const SafetyLimits & limits, const ControllerState & state);
  /// Tool force as a fraction of the one that check() would report, at the last check().
  double force_ratio() const { return force_ratio_; }
  /// Tolerates the current tool force after a protective stop was unlocked, until the tool is free again or
  /// the force grows.
  void tolerate_present_force();

 private:
  /// Names the joint on which the contact exerts the largest torque.
  ErrorCode collision_code(const ControllerState & state) const;
  std::optional<ExceededLimit> check_joints(const SafetyLimits & limits, const JointState & joints) const;
  std::optional<ExceededLimit> check_force(const SafetyLimits & limits, const ControllerState & state);

  const RobotModel & model_;
  double cycle_time_;
  double filtered_force_ = 0.0;
  double tolerated_force_ = 0.0;  ///< N; force when the stop was unlocked, lowered as the force decreases
  bool tolerate_next_force_ = false;
  double force_ratio_ = 0.0;
};

}  // namespace ur_simulator
