#include "move_until_wrench.hpp"

namespace ur_ros_rtde {

class MoveUntilTorque : public MoveUntilWrench {
 public:
  MoveUntilTorque() : MoveUntilWrench({3, 100.0, "Nm"}) {}
};

UR_ROS_RTDE_EXPORT(MoveUntilTorque, "move_until_torque")

}  // namespace ur_ros_rtde
