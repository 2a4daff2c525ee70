#pragma once

#include "motion/servo/speed_motion.hpp"
#include "motion/tcp_kinematics.hpp"

namespace ur_simulator {

/// speedl and stopl: the twist of the TCP goes straight to its target, the linear and the angular part
/// together. The linear part does not change faster than `acceleration` (m/s^2), the angular part not faster
/// than `rotational_acceleration` (rad/s^2).
class LinearSpeedMotion final : public SpeedMotion {
 public:
  LinearSpeedMotion(const TcpKinematics & kinematics, const Setpoint & start, const Vector6 & twist,
                    double acceleration, double rotational_acceleration, double time);

  std::optional<MotionFault> advance(const TimeStep & time_step, Setpoint & setpoint) override;

 private:
  TcpKinematics kinematics_;
  double acceleration_ratio_;  ///< linear to angular
  Transform pose_;
  Vector6 twist_;
};

}  // namespace ur_simulator
