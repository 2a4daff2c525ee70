#include "nodes/server.hpp"

#include <cstdlib>
#include <rcl_cxx/node.hpp>

namespace ur_ros_rtde {

void exit_without(const std::vector<std::string> & goals, const rcl_cxx::Node & node)
{
  for (const std::string & goal : goals) {
    RCL_CXX_FATAL(node.get_logger(), "goal {} did not end, the process exits without it", goal);
  }
  if (!goals.empty()) {
    std::_Exit(1);
  }
}

}  // namespace ur_ros_rtde
