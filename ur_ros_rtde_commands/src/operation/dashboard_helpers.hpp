#pragma once

#include <chrono>
#include <string>

#include "ur_ros_rtde_robot/connection/dashboard_session.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Long enough for a controller with nothing else to do.
inline constexpr std::chrono::milliseconds dashboard_timeout{2000};

/// Sends a line to the dashboard server and returns its answer. Throws RobotError (link_lost, timeout).
std::string send_to_dashboard(DashboardSession & dashboard, const std::string & line,
                              std::chrono::milliseconds timeout = dashboard_timeout);
/// Sends a query and returns its answer without the label: "RUNNING" for "Robotmode: RUNNING".
std::string query_dashboard(DashboardSession & dashboard, const std::string & query);
/// Sends a command. Fails (rejected_by_robot) with the answer unless it begins with `reply`.
Status command_dashboard(DashboardSession & dashboard, const std::string & line, const std::string & reply,
                         std::chrono::milliseconds timeout = dashboard_timeout);

}  // namespace ur_ros_rtde
