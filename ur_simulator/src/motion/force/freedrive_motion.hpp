#pragma once

#include <array>

#include "kinematics/robot_model.hpp"
#include "motion/force/forward_dynamics.hpp"
#include "motion/motion.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// freedrive_mode() and teach_mode(): the arm is guided by hand. It has inertia and some friction; gravity is
/// compensated. With fewer than six free axes the TCP keeps its position and orientation along and about the
/// other axes of the feature.
class FreedriveMotion final : public Motion {
 public:
  /// `feature` is a pose in the base frame; its axes apply.
  FreedriveMotion(const RobotModel & model, ForwardDynamics & dynamics, const ControllerState & state,
                  const std::array<bool, 6> & free_axes, const Vector6 & feature);

  std::optional<MotionFault> advance(const TimeStep & time_step, Setpoint & setpoint) override;
  bool call_complete() const override { return true; }
  bool finished() const override { return finished_; }
  void decelerate() override { decelerating_ = true; }
  bool controls_actual_joints() const override { return true; }

 private:
  Vector6 guided_velocity(const TimeStep & time_step, const Setpoint & setpoint) const;
  Vector6 constrained_velocity(const Vector6 & velocity, const Setpoint & setpoint) const;
  bool constrained() const;

  const RobotModel * model_;
  ForwardDynamics * dynamics_;
  const ControllerState * state_;
  std::array<bool, 6> free_axes_;
  Eigen::Matrix3d axes_;
  Transform start_;
  bool decelerating_ = false;
  bool finished_ = false;
};

}  // namespace ur_simulator
