#pragma once

#include "kinematics/robot_model.hpp"
#include "motion/servo/speed_motion.hpp"

namespace ur_simulator {

/// speedj, stopj and every other stop: all joint velocities reach their targets at the same time; the one
/// that changes most changes at `acceleration`. A joint near its position limit decelerates to standstill at
/// the limit; if it is driven further, the motion ends in a fault.
class JointSpeedMotion final : public SpeedMotion {
 public:
  JointSpeedMotion(const RobotModel & model, const Vector6 & velocity, double acceleration, double time);
  static JointSpeedMotion stop(const RobotModel & model, double deceleration);

  std::optional<MotionFault> advance(const TimeStep & time_step, Setpoint & setpoint) override;

 private:
  std::optional<MotionFault> keep_within_limits(const TimeStep & time_step, const Setpoint & setpoint,
                                                Vector6 & velocity) const;

  const RobotModel * model_;
};

}  // namespace ur_simulator
