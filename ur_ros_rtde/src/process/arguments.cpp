#include "process/arguments.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace ur_ros_rtde {
namespace {
std::string usage(const std::string & program)
{
  return fmt::format(
      "usage: {0} --ros-args -p robot_ip:=ADDRESS [-p NAME:=VALUE ...] [--params-file FILE] [-r "
      "__ns:=/NAMESPACE]\n"
      "\n"
      "robot_ip is the address of the robot's controller. The file config/driver.yaml of the package "
      "ur_ros_rtde\n"
      "has all parameters with their defaults; `ros2 param describe` explains those of a running node.\n",
      program);
}
}  // namespace

tl::expected<std::string, std::string> help_asked_for(const std::vector<std::string> & arguments)
{
  const std::string program = std::filesystem::path(arguments.front()).filename();
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    if (arguments[i] == "--help" || arguments[i] == "-h") {
      return usage(program);
    }
    if (arguments[i] == "--version") {
      return fmt::format("ur_ros_rtde {}\n", UR_ROS_RTDE_VERSION);
    }
  }
  if (arguments.size() > 1) {
    return tl::unexpected(
        fmt::format("there is no argument \"{}\": parameters follow --ros-args -p. {} --help shows how",
                    arguments[1], program));
  }
  return {};
}

}  // namespace ur_ros_rtde
