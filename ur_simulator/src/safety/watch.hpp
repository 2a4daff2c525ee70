#pragma once

#include <optional>
#include <string>

#include "kinematics/robot_model.hpp"
#include "safety/limits.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// Watches the actual state against the limits, cycle by cycle.
class LimitWatch {
 public:
  LimitWatch(const RobotModel & model, double cycle_time) : model_(model), cycle_time_(cycle_time) {}

  /// The first limit that is exceeded, in words: value, limit and what to do.
  std::optional<std::string> check(const SafetyLimits & limits, const ControllerState & state);
  /// After a stop was unlocked: a tool that still presses may do so, if it presses no harder, until it is
  /// free.
  void relent();

 private:
  std::optional<std::string> check_joints(const SafetyLimits & limits, const JointState & joints) const;
  std::optional<std::string> check_force(const SafetyLimits & limits, const ControllerState & state);

  const RobotModel & model_;
  double cycle_time_;
  double filtered_force_ = 0.0;
  double forgiven_ = 0.0;  ///< N that the tool pressed with when the stop was unlocked, less since it let go
  bool relenting_ = false;
};

}  // namespace ur_simulator
