#pragma once

#include "kinematics/robot_model.hpp"
#include "motion/motion.hpp"

namespace ur_simulator {

/// servoj: a second-order filter that follows a joint target, qdd = gain (target - q - lookahead qd). This
/// matches the script manual ("servoj"): `lookahead_time` projects the position forward, `gain` pulls it to
/// the target. The target is followed until another motion starts. The lookahead is lengthened where the
/// damping ratio would be below `min_damping_ratio`.
class JointServoMotion final : public Motion {
 public:
  static constexpr double min_damping_ratio = 0.8;
  static constexpr double acceleration_limit = 40.0;  ///< rad/s^2

  JointServoMotion(const RobotModel & model, const Vector6 & target, double time, double lookahead,
                   double gain);

  std::optional<MotionFault> advance(const TimeStep & time_step, Setpoint & setpoint) override;
  bool call_complete() const override { return time_left_ <= 0.0; }
  bool finished() const override { return finished_; }
  bool is_unattended() const override { return call_complete(); }
  void decelerate() override { decelerating_ = true; }

 private:
  double next_velocity(Eigen::Index joint, double duration, const Setpoint & setpoint) const;

  const RobotModel * model_;
  Vector6 target_;
  double time_left_;
  double gain_;
  double lookahead_;
  bool decelerating_ = false;
  bool finished_ = false;
};

}  // namespace ur_simulator
