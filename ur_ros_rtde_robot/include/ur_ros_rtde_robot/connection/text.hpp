#pragma once

#include <string>
#include <string_view>

namespace ur_ros_rtde {

/// What came over a link as text that can be sent on: UTF-8 without control characters but line ends and
/// tabs; '?' for all else. A ROS message with a zero byte in a text cannot be sent, and one that is no UTF-8
/// cannot be read in Python.
std::string printable(std::string_view text);

}  // namespace ur_ros_rtde
