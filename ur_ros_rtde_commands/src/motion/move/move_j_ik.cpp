#include <ur_ros_rtde_msgs/action/move_jik.hpp>

#include "motion/move/move_to_target.hpp"

namespace ur_ros_rtde {

class MoveJIK : public MoveToTarget<ur_ros_rtde_msgs::action::MoveJIK> {
 public:
  MoveJIK() : MoveToTarget(&ur_rtde::RTDEControlInterface::moveJ_IK, joint_speed_limits) {}
};

UR_ROS_RTDE_EXPORT(MoveJIK, "move_j_ik")

}  // namespace ur_ros_rtde
