#include "motion/stop/decelerate.hpp"

namespace ur_ros_rtde {

/// Stops setpoints of joints (rad/s^2) as well as those of poses (m/s^2).
class ServoStop : public DecelerateCommand {
 public:
  ServoStop()
      : DecelerateCommand({&StopOptions::joint_deceleration, &StopOptions::linear_deceleration},
                          max_servo_deceleration, "rad/s^2 or m/s^2")
  {
  }
};

UR_ROS_RTDE_EXPORT(ServoStop, "servo_stop")

}  // namespace ur_ros_rtde
