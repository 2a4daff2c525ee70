#include <cstdlib>

#include "ur_ros_rtde/plugin.hpp"

namespace test {

/// Ends the process with exit code 3 when it is destroyed.
class ExitsWhenDestroyed : public ur_ros_rtde::CommandPlugin {
 public:
  ~ExitsWhenDestroyed() override { std::_Exit(3); }

 private:
  void start_action_server(ur_ros_rtde::CommandHost &, const std::string &) override {}
  void stop_action_server() override {}
};

UR_ROS_RTDE_EXPORT(ExitsWhenDestroyed, "exits_when_destroyed")

}  // namespace test
