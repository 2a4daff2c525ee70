#pragma once

#include "kinematics/robot_model.hpp"
#include "motion/motion.hpp"

namespace ur_simulator {

/// speedj, stopj and every stop: the joint velocities go to their targets together, the one with the longest
/// way at `acceleration`. A joint that comes near its position limit brakes to stand still at it, and faults
/// there when it is still driven on.
class JointSpeed final : public Motion {
 public:
  /// `time` s after which the arm decelerates by itself; 0: never.
  JointSpeed(const RobotModel & model, const Vector6 & velocity, double acceleration, double time);
  static JointSpeed stop(const RobotModel & model, double deceleration);

  std::optional<MotionFault> advance(const Tick & tick, Setpoint & now) override;
  bool released() const override { return released_; }
  bool done() const override { return done_; }
  void brake() override;

 private:
  std::optional<MotionFault> keep_within_limits(const Tick & tick, const Setpoint & now,
                                                Vector6 & velocity) const;

  const RobotModel * model_;
  Vector6 target_;
  double acceleration_;
  double time_;
  double elapsed_ = 0.0;
  bool released_ = false;
  bool done_ = false;
};

}  // namespace ur_simulator
