#include <stdexcept>

#include "ur_ros_rtde/plugin.hpp"

namespace test {

class Throws : public ur_ros_rtde::CommandPlugin {
 public:
  Throws() { throw std::runtime_error("the gripper is not there"); }
  void start_action_server(ur_ros_rtde::CommandHost &, const std::string &) override {}
  void stop_action_server() override {}
};

UR_ROS_RTDE_EXPORT(Throws, "throws")

}  // namespace test
