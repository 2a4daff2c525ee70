#pragma once

#include <rcl_cxx/node.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "ur_ros_rtde_robot/connection/log.hpp"

namespace ur_ros_rtde {

/// Writes the messages of the robot package to the log of a node.
LogFunction log_to(const rcl_cxx::Logger & logger);

/// The same for the state of connections. During a shutdown a lost connection is expected, so problems are
/// logged at the debug level.
LogFunction log_connection(const rcl_cxx::Node & node);

/// Logs the actions that a server offers, `what` being "commands". If they are many, only their number, and
/// their names at the debug level.
void log_commands(const rcl_cxx::Logger & logger, std::string_view what,
                  const std::vector<std::string> & names);

}  // namespace ur_ros_rtde
