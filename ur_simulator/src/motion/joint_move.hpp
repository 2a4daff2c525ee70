#pragma once

#include "kinematics/robot_model.hpp"
#include "motion/arm.hpp"
#include "motion/motion.hpp"
#include "motion/profile.hpp"
#include "motion/takeover.hpp"

namespace ur_simulator {

/// movej: all joints start and end together on one trapezoid; speed and acceleration are those of the joint
/// with the longest way.
class JointMove final : public Motion {
 public:
  JointMove(const RobotModel & model, const Setpoint & from, const Vector6 & target,
            const MoveOptions & options);

  std::optional<MotionFault> advance(const Tick & tick, Setpoint & now) override;
  bool released() const override { return done(); }
  bool done() const override { return done_; }
  void brake() override;

 private:
  Vector6 start_;
  Vector6 target_;
  Vector6 direction_ = Vector6::Zero();  ///< rad of each joint per rad of the leading one
  Runout runout_;
  TrapezoidProfile profile_;
  PathClock clock_;
  bool done_ = false;
};

}  // namespace ur_simulator
