#pragma once

#include <rcl_cxx/context.hpp>

#include "nodes/server.hpp"

namespace ur_ros_rtde {

Servers make_robot_state_receiver(const rcl_cxx::Context::SharedPtr & context);
Servers make_command_server(const rcl_cxx::Context::SharedPtr & context);
Servers make_dashboard_server(const rcl_cxx::Context::SharedPtr & context);
/// The three nodes in one process, with one RTDE connection for the state.
Servers make_driver(const rcl_cxx::Context::SharedPtr & context);

}  // namespace ur_ros_rtde
