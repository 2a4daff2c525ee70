#pragma once

namespace ur_ros_rtde {

struct TeleoperationOptions {
  double timeout = 0.1;          ///< s without a message after which a stream is over
  double max_joint_jump = 0.2;   ///< rad, of a target from where the arm is sent; also of a pose's rotation
  double max_linear_jump = 0.1;  ///< m
  double acceleration = 1.0;     ///< m/s^2, of a twist
  double deceleration = 2.0;     ///< rad/s^2, m/s^2, of the stop at the end
  double lookahead_time = 0.1;   ///< s, of servo control
  double gain = 300.0;           ///< of servo control
};

}  // namespace ur_ros_rtde
