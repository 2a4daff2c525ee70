#include "motion/servo/linear_speed_motion.hpp"

#include <algorithm>

#include "common/pose.hpp"

namespace ur_simulator {

LinearSpeedMotion::LinearSpeedMotion(const TcpKinematics & kinematics, const Setpoint & start,
                                     const Vector6 & twist, double acceleration,
                                     double rotational_acceleration, double time)
    : SpeedMotion(twist, acceleration, time),
      kinematics_(kinematics),
      acceleration_ratio_(acceleration / rotational_acceleration),
      pose_(kinematics.tcp_pose(start.position)),
      twist_(kinematics.tcp_twist(start))
{
}

std::optional<MotionFault> LinearSpeedMotion::advance(const TimeStep & time_step, Setpoint & setpoint)
{
  begin_cycle(time_step);
  const Vector6 next = next_velocity(twist_, [this](const Vector6 & change) {
    return std::max(change.head<3>().norm(), acceleration_ratio_ * change.tail<3>().norm());
  });
  const Vector6 displacement = 0.5 * time_step.duration * (twist_ + next);
  Transform pose = pose_;
  pose.translation() += displacement.head<3>();
  // Normalized in every cycle, so that rounding errors do not accumulate.
  pose.linear() = Eigen::Quaterniond(to_rotation_matrix(displacement.tail<3>()) * pose_.linear())
                      .normalized()
                      .toRotationMatrix();
  if (const auto fault = kinematics_.move_to(pose, time_step.duration, setpoint)) {
    return fault;
  }
  pose_ = pose;
  twist_ = next;
  end_cycle(twist_);
  if (finished()) {
    setpoint.velocity.setZero();
  }
  return std::nullopt;
}

}  // namespace ur_simulator
