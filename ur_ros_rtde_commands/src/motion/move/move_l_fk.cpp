#include <ur_ros_rtde_msgs/action/move_lfk.hpp>

#include "motion/move/move_to_target.hpp"

namespace ur_ros_rtde {

class MoveLFK : public MoveToTarget<ur_ros_rtde_msgs::action::MoveLFK> {
 public:
  MoveLFK() : MoveToTarget(&ur_rtde::RTDEControlInterface::moveL_FK, linear_speed_limits) {}
};

UR_ROS_RTDE_EXPORT(MoveLFK, "move_l_fk")

}  // namespace ur_ros_rtde
