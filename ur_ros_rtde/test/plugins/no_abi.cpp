#include "ur_ros_rtde/plugin.hpp"

namespace test {

class NoAbi : public ur_ros_rtde::CommandPlugin {
  void start_action_server(ur_ros_rtde::CommandHost &, const std::string &) override {}
  void stop_action_server() override {}
};

UR_ROS_RTDE_EXPORT(NoAbi, "no_abi")

}  // namespace test
