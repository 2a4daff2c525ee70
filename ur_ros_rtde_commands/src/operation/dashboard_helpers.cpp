#include "operation/dashboard_helpers.hpp"

#include <fmt/format.h>

namespace ur_ros_rtde {

std::string send_to_dashboard(DashboardSession & dashboard, const std::string & line,
                              std::chrono::milliseconds timeout)
{
  const auto answer = dashboard.request(line, timeout);
  if (!answer) {
    throw RobotError({answer.error().code, fmt::format("the dashboard server did not answer \"{}\": {}", line,
                                                       answer.error().message)});
  }
  return *answer;
}

std::string query_dashboard(DashboardSession & dashboard, const std::string & query)
{
  const std::string answer = send_to_dashboard(dashboard, query);
  const auto colon = answer.find(": ");
  return colon == std::string::npos ? answer : answer.substr(colon + 2);
}

Status command_dashboard(DashboardSession & dashboard, const std::string & line, const std::string & reply,
                         std::chrono::milliseconds timeout)
{
  const std::string answer = send_to_dashboard(dashboard, line, timeout);
  if (answer.rfind(reply, 0) == 0) {
    return {};
  }
  return failure(ErrorCode::rejected_by_robot,
                 fmt::format("the dashboard server answered \"{}\" to \"{}\"", answer, line));
}

}  // namespace ur_ros_rtde
