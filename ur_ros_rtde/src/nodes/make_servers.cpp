#include "nodes/make_servers.hpp"

#include "nodes/command_server.hpp"
#include "nodes/dashboard_server.hpp"
#include "nodes/state_server.hpp"

namespace ur_ros_rtde {
namespace {

template <typename Node>
Servers make_single(const rcl_cxx::Context::SharedPtr & context)
{
  Servers servers;
  servers.push_back(std::make_unique<Node>(context));
  return servers;
}

}  // namespace

Servers make_robot_state_receiver(const rcl_cxx::Context::SharedPtr & context)
{
  return make_single<StateServer>(context);
}

Servers make_command_server(const rcl_cxx::Context::SharedPtr & context)
{
  return make_single<CommandServer>(context);
}

Servers make_dashboard_server(const rcl_cxx::Context::SharedPtr & context)
{
  return make_single<DashboardServer>(context);
}

Servers make_driver(const rcl_cxx::Context::SharedPtr & context)
{
  auto commands = std::make_unique<CommandServer>(context);
  auto state = std::make_unique<SharedStateServer>(context, commands->robot());
  auto dashboard = std::make_unique<DashboardServer>(context, &commands->host());
  Servers servers;
  servers.push_back(std::move(state));  // outlives the robot, which calls it
  servers.push_back(std::move(commands));
  servers.push_back(std::move(dashboard));  // is closed and destroyed before the robot, which it calls
  return servers;
}

}  // namespace ur_ros_rtde
