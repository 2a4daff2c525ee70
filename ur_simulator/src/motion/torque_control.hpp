#pragma once

#include "kinematics/robot_model.hpp"
#include "motion/forward_dynamics.hpp"
#include "motion/motion.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// direct_torque(): the joints obey torques for one cycle, gravity compensated. Unless another call follows
/// in the next cycle, position control takes over and brings the arm to rest.
class TorqueControl final : public Motion {
 public:
  /// N m; the parts (0..1 a joint) of viscous and Coulomb friction that the controller compensates.
  TorqueControl(const RobotModel & model, ForwardDynamics & dynamics, const ControllerState & state,
                const Vector6 & torque, const Vector6 & viscous_scale, const Vector6 & coulomb_scale);

  std::optional<MotionFault> advance(const Tick & tick, Setpoint & now) override;
  bool released() const override { return served_; }
  bool done() const override { return done_; }
  void brake() override { served_ = true; }
  bool leads_actual() const override { return true; }

 private:
  ForwardDynamics * dynamics_;
  const ControllerState * state_;
  Vector6 torque_;
  JointFriction friction_;
  bool served_ = false;
  bool done_ = false;
};

}  // namespace ur_simulator
