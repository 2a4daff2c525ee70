#pragma once

#include <rcl/arguments.h>

#include <map>
#include <string>
#include <vector>

#include "rcl_cxx/parameter.hpp"

namespace rcl_cxx::detail {
/// Arguments of one node (NodeOptions::arguments), parsed.
class ParsedArguments {
 public:
  /// @throws Error for malformed or unknown ROS arguments
  explicit ParsedArguments(const std::vector<std::string> & arguments);
  ~ParsedArguments();
  ParsedArguments(const ParsedArguments &) = delete;
  ParsedArguments & operator=(const ParsedArguments &) = delete;

  const rcl_arguments_t & get() const noexcept { return arguments_; }

 private:
  rcl_arguments_t arguments_;
};

/// @throws Error that names what stands between --ros-args and its end and is no ROS argument
void refuse_unknown_ros_arguments(const rcl_arguments_t & arguments, const char * const * argv);

std::vector<std::string> without_ros_arguments(const rcl_arguments_t & arguments, const char * const * argv);

/// Whether a node name of a parameter file ("/robot/driver", "driver", "/**", "/*/driver") means this node:
/// '*' is one part of the name, '**' any number of them.
bool names_node(std::string_view pattern, std::string_view fully_qualified_name);

/// Adds to `overrides` what -p and --params-file say about the node; what comes later wins.
void read_parameter_overrides(const rcl_arguments_t & arguments, const std::string & fully_qualified_name,
                              std::map<std::string, ParameterValue> & overrides);

}  // namespace rcl_cxx::detail
