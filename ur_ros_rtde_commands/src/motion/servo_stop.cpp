#include "decelerate.hpp"

namespace ur_ros_rtde {

/// The control script ends servo control along the TCP's line.
class ServoStop : public DecelerateCommand {
 public:
  ServoStop() : DecelerateCommand({&StopOptions::linear_deceleration}, highest_joint_deceleration, "m/s^2") {}
};

UR_ROS_RTDE_EXPORT(ServoStop, "servo_stop")

}  // namespace ur_ros_rtde
