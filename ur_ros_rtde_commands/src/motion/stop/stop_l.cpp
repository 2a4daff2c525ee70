#include "motion/stop/decelerate.hpp"

namespace ur_ros_rtde {

class StopL : public DecelerateCommand {
 public:
  StopL() : DecelerateCommand({&StopOptions::linear_deceleration}, max_linear_deceleration, "m/s^2") {}
};

UR_ROS_RTDE_EXPORT(StopL, "stop_l")

}  // namespace ur_ros_rtde
