#pragma once

#include "kinematics/robot_model.hpp"
#include "motion/motion.hpp"

namespace ur_simulator {

/// servoj: a filter that follows a joint target, qdd = gain (target - q - lookahead qd), as the script manual
/// describes its parameters: the position projected forwards by `lookahead`, pulled to the target by `gain`.
/// The target is tracked until another motion comes. Where the parameters would make it swing (damping ratio
/// under `least_damping`) the lookahead is lengthened.
class JointServo final : public Motion {
 public:
  JointServo(const RobotModel & model, const Vector6 & target, double time, double lookahead, double gain);

  std::optional<MotionFault> advance(const Tick & tick, Setpoint & now) override;
  bool released() const override { return time_left_ <= 0.0; }
  bool done() const override { return done_; }
  void brake() override { braking_ = true; }

  static constexpr double least_damping = 0.8;
  static constexpr double acceleration_limit = 40.0;  ///< rad/s^2

 private:
  double next_velocity(Eigen::Index joint, double duration, const Setpoint & now) const;

  const RobotModel * model_;
  Vector6 target_;
  double time_left_;
  double gain_;
  double lookahead_;
  bool braking_ = false;
  bool done_ = false;
};

}  // namespace ur_simulator
