#include "decelerate.hpp"

namespace ur_ros_rtde {

/// Of speed_j as well as speed_l, each in its unit.
class SpeedStop : public DecelerateCommand {
 public:
  SpeedStop()
      : DecelerateCommand({&StopOptions::joint_deceleration, &StopOptions::linear_deceleration},
                          highest_linear_deceleration, "m/s^2")
  {
  }
};

UR_ROS_RTDE_EXPORT(SpeedStop, "speed_stop")

}  // namespace ur_ros_rtde
