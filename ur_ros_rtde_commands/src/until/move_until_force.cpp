#include "move_until_wrench.hpp"

namespace ur_ros_rtde {

class MoveUntilForce : public MoveUntilWrench {
 public:
  MoveUntilForce() : MoveUntilWrench({0, 500.0, "N"}) {}
};

UR_ROS_RTDE_EXPORT(MoveUntilForce, "move_until_force")

}  // namespace ur_ros_rtde
