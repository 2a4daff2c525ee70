#pragma once

#include <rcl_cxx/node.hpp>

#include "ur_ros_rtde_robot/connection/log.hpp"

namespace ur_ros_rtde {

/// What the robot side says, in the node's log.
LogFunction log_into(const rcl_cxx::Logger & logger);

/// The same for what reports the state of a connection: in a shutdown a lost one is no problem, and goes to
/// the debug level.
LogFunction log_connection(const rcl_cxx::Node & node);

}  // namespace ur_ros_rtde
