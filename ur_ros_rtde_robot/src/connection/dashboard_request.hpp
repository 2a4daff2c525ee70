#pragma once

#include <chrono>
#include <stop_token>
#include <string>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Sends a line to the dashboard server at `address` on a separate connection and returns the answer without
/// the line end. An e-Series controller applies to each client the control mode, local or remote, at the time
/// of connecting; a new connection therefore has the current mode. Errors: link_lost; timeout after
/// `timeout`; canceled if a stop is requested.
Expected<std::string> dashboard_request(const std::string & address, const std::string & line,
                                        std::chrono::milliseconds timeout, const std::stop_token & stop);

/// Returns whether a program plays on the robot; true if the dashboard server does not tell.
bool may_play(const std::string & address);

/// Stops the program that runs on the robot. Fails with the robot's answer if it does not; timeout if the
/// robot has not answered `timeout` after the request, which it may still execute. It answers when the
/// program has ended.
Status stop_program(const std::string & address, std::chrono::milliseconds timeout);

}  // namespace ur_ros_rtde
