#include "motion/stop/decelerate.hpp"

namespace ur_ros_rtde {

class ServoStop : public DecelerateCommand {
 public:
  ServoStop() : DecelerateCommand({&StopOptions::linear_deceleration}, max_servo_deceleration, "m/s^2") {}
};

UR_ROS_RTDE_EXPORT(ServoStop, "servo_stop")

}  // namespace ur_ros_rtde
