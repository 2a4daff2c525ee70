#pragma once

#include <rcl_cxx/node.hpp>

#include "ur_ros_rtde_robot/connection/log.hpp"

namespace ur_ros_rtde {

/// Writes the messages of the robot package to the log of a node.
LogFunction log_to(const rcl_cxx::Logger & logger);

/// The same for the state of connections. During a shutdown a lost connection is expected, so problems are
/// logged at the debug level.
LogFunction log_connection(const rcl_cxx::Node & node);

}  // namespace ur_ros_rtde
