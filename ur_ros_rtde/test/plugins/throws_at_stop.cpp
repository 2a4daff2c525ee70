#include <stdexcept>

#include "ur_ros_rtde/plugin.hpp"

namespace test {

class ThrowsAtStop : public ur_ros_rtde::CommandPlugin {
  void start_action_server(ur_ros_rtde::CommandHost &, const std::string &) override {}
  void stop_action_server() override { throw std::runtime_error("the gripper does not answer"); }
};

UR_ROS_RTDE_EXPORT(ThrowsAtStop, "throws_at_stop")

}  // namespace test
