#include "decelerate.hpp"

namespace ur_ros_rtde {

/// The control script stops servo motion with a linear deceleration of the TCP.
class ServoStop : public DecelerateCommand {
 public:
  ServoStop() : DecelerateCommand({&StopOptions::linear_deceleration}, max_joint_deceleration, "m/s^2") {}
};

UR_ROS_RTDE_EXPORT(ServoStop, "servo_stop")

}  // namespace ur_ros_rtde
