#include <ur_ros_rtde_msgs/action/move_j.hpp>

#include "motion/move/move_to_target.hpp"

namespace ur_ros_rtde {

class MoveJ : public MoveToTarget<ur_ros_rtde_msgs::action::MoveJ> {
 public:
  MoveJ() : MoveToTarget(&ur_rtde::RTDEControlInterface::moveJ, joint_speed_limits) {}
};

UR_ROS_RTDE_EXPORT(MoveJ, "move_j")

}  // namespace ur_ros_rtde
