#pragma once

#include <chrono>
#include <stop_token>
#include <string>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Sends a line to the dashboard server at `address` on a connection of its own and returns the answer
/// without its end. An e-Series controller keeps to the control mode, local or remote, that it had when a
/// client connected: a new connection has today's. Errors: link_lost; timeout, when `limit` has passed;
/// canceled, when stop is requested.
Expected<std::string> dashboard_request(const std::string & address, const std::string & line,
                                        std::chrono::milliseconds limit, const std::stop_token & stop);

}  // namespace ur_ros_rtde
