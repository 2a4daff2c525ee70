#include <ur_ros_rtde_msgs/action/move_l.hpp>

#include "motion/move/move_to_target.hpp"

namespace ur_ros_rtde {

class MoveL : public MoveToTarget<ur_ros_rtde_msgs::action::MoveL> {
 public:
  MoveL() : MoveToTarget(&ur_rtde::RTDEControlInterface::moveL, linear_speed_limits) {}
};

UR_ROS_RTDE_EXPORT(MoveL, "move_l")

}  // namespace ur_ros_rtde
