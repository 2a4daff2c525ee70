#include "nodes/command_server.hpp"
#include "nodes/dashboard_server.hpp"
#include "nodes/state_server.hpp"
#include "process/process.hpp"

/// The three nodes in one process, with one RTDE connection for the state.
int main(int argc, char ** argv)
{
  return ur_ros_rtde::run_process(argc, argv, [](const auto & context) {
    auto commands = std::make_unique<ur_ros_rtde::CommandServer>(context);
    auto state = std::make_unique<ur_ros_rtde::SharedStateServer>(context, commands->robot());
    ur_ros_rtde::Servers servers;
    servers.push_back(std::move(state));  // outlives the robot, which calls it
    servers.push_back(std::move(commands));
    servers.push_back(std::make_unique<ur_ros_rtde::DashboardServer>(context));
    return servers;
  });
}
