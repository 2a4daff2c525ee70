#include "ur_ros_rtde/plugin.hpp"

namespace test {

class WrongBase : public ur_ros_rtde::DashboardPlugin {
  void start_action_server(ur_ros_rtde::DashboardHost &, const std::string &) override {}
  void stop_action_server() override {}
};

UR_ROS_RTDE_EXPORT(WrongBase, "wrong_base")

}  // namespace test
