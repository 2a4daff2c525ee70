#pragma once

#include <string>
#include <string_view>

namespace ur_ros_rtde {

/// Makes text received from the network safe to forward: UTF-8 without control characters other than line
/// feed and tab; every other byte becomes '?'. A ROS message cannot hold a zero byte in a string, and Python
/// cannot read a string that is not UTF-8.
std::string printable(std::string_view text);

}  // namespace ur_ros_rtde
