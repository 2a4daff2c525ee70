#pragma once

#include <rcl/arguments.h>

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "rcl_cxx/parameter_value.hpp"

namespace rcl_cxx::detail {
/// @throws Error that names the arguments after --ros-args that are not ROS arguments
void check_ros_arguments(const rcl_arguments_t & arguments, const char * const * argv);

std::vector<std::string> remove_ros_arguments(const rcl_arguments_t & arguments, const char * const * argv);

/// Returns whether a node name of a parameter file ("/robot/driver", "driver", "/**", "/*/driver") matches
/// this node: '*' stands for one part of the name, '**' for any number of parts.
bool matches_node(std::string_view pattern, std::string_view fully_qualified_name);

/// The parameters that -p and --params-file set for this node. Later arguments win.
std::map<std::string, ParameterValue> read_parameter_overrides(const rcl_arguments_t & arguments,
                                                               const std::string & fully_qualified_name);

}  // namespace rcl_cxx::detail
