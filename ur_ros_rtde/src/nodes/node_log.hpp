#pragma once

#include <rcl_cxx/node.hpp>

#include "ur_ros_rtde/log.hpp"

namespace ur_ros_rtde {

/// What the robot side says, in the node's log.
LogFunction log_into(const rcl_cxx::Logger & logger);

}  // namespace ur_ros_rtde
