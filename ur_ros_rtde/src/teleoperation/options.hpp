#pragma once

namespace ur_ros_rtde {

struct TeleoperationOptions {
  double timeout = 0.1;  ///< s without a message that end a session
  double max_joint_jump =
      0.2;  ///< rad, largest distance of a target from the last command; also for the rotation of a pose
  double max_linear_jump = 0.1;  ///< m, the same for the position of a pose
  double acceleration = 1.0;     ///< m/s^2, for twist
  double deceleration = 2.0;     ///< rad/s^2, m/s^2, for the stop at the end of a session
  double lookahead_time = 0.1;   ///< s, servo control
  double gain = 300.0;           ///< servo control
};

}  // namespace ur_ros_rtde
