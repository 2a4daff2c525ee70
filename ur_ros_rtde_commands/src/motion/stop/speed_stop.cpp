#include "motion/stop/decelerate.hpp"

namespace ur_ros_rtde {

/// Stops speed_j (rad/s^2) as well as speed_l (m/s^2).
class SpeedStop : public DecelerateCommand {
 public:
  SpeedStop()
      : DecelerateCommand({&StopOptions::joint_deceleration, &StopOptions::linear_deceleration},
                          max_linear_deceleration, "m/s^2")
  {
  }
};

UR_ROS_RTDE_EXPORT(SpeedStop, "speed_stop")

}  // namespace ur_ros_rtde
