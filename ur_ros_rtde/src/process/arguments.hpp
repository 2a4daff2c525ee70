#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace ur_ros_rtde {

/// The text for --help or --version; empty if neither is asked for. `arguments` are those that are not for
/// ROS, beginning with the program's name. Fails with a message that names an argument that the program does
/// not have.
tl::expected<std::string, std::string> help_asked_for(const std::vector<std::string> & arguments);

}  // namespace ur_ros_rtde
