#include "motion/stop/decelerate.hpp"

namespace ur_ros_rtde {

class StopJ : public DecelerateCommand {
 public:
  StopJ() : DecelerateCommand({&StopOptions::joint_deceleration}, max_joint_deceleration, "rad/s^2") {}
};

UR_ROS_RTDE_EXPORT(StopJ, "stop_j")

}  // namespace ur_ros_rtde
