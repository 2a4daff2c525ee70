#pragma once

#include <array>

#include "kinematics/robot_model.hpp"
#include "motion/forward_dynamics.hpp"
#include "motion/motion.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// freedrive_mode() and teach_mode(): hands lead the arm, which has its mass and some friction but no weight.
/// With fewer than six free axes the TCP keeps its place along and about the others, in the axes of the
/// feature.
class Freedrive final : public Motion {
 public:
  Freedrive(const RobotModel & model, ForwardDynamics & dynamics, const ControllerState & state,
            const std::array<bool, 6> & free_axes, const Vector6 & feature);

  std::optional<MotionFault> advance(const Tick & tick, Setpoint & now) override;
  bool released() const override { return true; }
  bool done() const override { return done_; }
  void brake() override { braking_ = true; }
  bool leads_actual() const override { return true; }

 private:
  Vector6 guided(const Tick & tick, const Setpoint & now) const;
  Vector6 held(const Vector6 & velocity, const Setpoint & now) const;
  bool constrained() const;

  const RobotModel * model_;
  ForwardDynamics * dynamics_;
  const ControllerState * state_;
  std::array<bool, 6> free_axes_;
  Eigen::Matrix3d axes_;
  Transform start_;
  bool braking_ = false;
  bool done_ = false;
};

}  // namespace ur_simulator
