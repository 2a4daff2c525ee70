#pragma once

#include <chrono>
#include <string>

#include "ur_ros_rtde_robot/connection/link.hpp"
#include "ur_ros_rtde_robot/connection/tcp_socket.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Queries the version of the controller at `address` over RTDE protocol version 2, within `timeout` for
/// connecting and for the queries. Use this before ur_rtde's constructors, which wait without a limit and do
/// not validate the answers.
Expected<ControllerVersion> probe_rtde(const std::string & address, std::chrono::milliseconds timeout);
/// The same over a new connection to `address`.
Expected<ControllerVersion> probe_rtde(TcpSocket socket, const std::string & address,
                                       std::chrono::milliseconds timeout);

/// Checks that a UR dashboard server answers on the new connection to `address`.
Status probe_dashboard(TcpSocket socket, const std::string & address, std::chrono::milliseconds timeout);

}  // namespace ur_ros_rtde
