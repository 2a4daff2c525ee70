#include "connection/dashboard_request.hpp"

#include <fmt/format.h>

#include "ur_ros_rtde_robot/connection/dashboard_session.hpp"

namespace ur_ros_rtde {
namespace {

constexpr std::chrono::milliseconds answer_timeout{500};

}  // namespace

Expected<std::string> dashboard_request(const std::string & address, const std::string & line,
                                        std::chrono::milliseconds timeout, const std::stop_token & stop)
{
  return DashboardSession(address).request(line, timeout, stop);
}

bool may_play(const std::string & address)
{
  const auto answer = dashboard_request(address, "programState", answer_timeout, {});
  return !answer || (!answer->starts_with("STOPPED") && !answer->starts_with("PAUSED"));
}

Status stop_program(const std::string & address, std::chrono::milliseconds timeout)
{
  const auto answer = dashboard_request(address, "stop", timeout, {});
  if (!answer) {
    return tl::unexpected(answer.error());
  }
  if (answer->find("Stopped") == std::string::npos) {
    return failure(ErrorCode::rejected_by_robot, fmt::format("the robot answered `stop` with: {}", *answer));
  }
  return {};
}

}  // namespace ur_ros_rtde
