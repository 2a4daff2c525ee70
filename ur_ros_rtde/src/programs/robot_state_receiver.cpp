#include "nodes/make_servers.hpp"
#include "process/process.hpp"

int main(int argc, char ** argv)
{
  return ur_ros_rtde::run_process(argc, argv, ur_ros_rtde::make_robot_state_receiver);
}
