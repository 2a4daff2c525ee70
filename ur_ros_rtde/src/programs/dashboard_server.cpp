#include "nodes/dashboard_server.hpp"

#include "process/process.hpp"

int main(int argc, char ** argv)
{
  return ur_ros_rtde::run_process(argc, argv, [](const auto & context) {
    ur_ros_rtde::Servers servers;
    servers.push_back(std::make_unique<ur_ros_rtde::DashboardServer>(context));
    return servers;
  });
}
