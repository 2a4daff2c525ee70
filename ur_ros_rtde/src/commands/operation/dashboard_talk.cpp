#include "commands/operation/dashboard_talk.hpp"

#include <fmt/format.h>
#include <ur_rtde/dashboard_client.h>

namespace ur_ros_rtde {

std::string ask_dashboard(const Robot & robot, const std::string & line)
{
  std::string answer;
  try {
    const auto client = robot.dashboard().hold();
    client->send(line + "\n");
    answer = client->receive();
  } catch (const RobotError &) {
    throw;
  } catch (const std::exception & error) {
    throw RobotError({ErrorCode::link_lost,
                      fmt::format("the dashboard server did not answer \"{}\": {}", line, error.what())});
  }
  answer.erase(answer.find_last_not_of(" \t\r\n") + 1);
  return answer;
}

std::string dashboard_value(const Robot & robot, const std::string & question)
{
  const std::string answer = ask_dashboard(robot, question);
  const auto colon = answer.find(": ");
  return colon == std::string::npos ? answer : answer.substr(colon + 2);
}

Status tell_dashboard(const Robot & robot, const std::string & line, const std::string & reply)
{
  const std::string answer = ask_dashboard(robot, line);
  if (answer.rfind(reply, 0) == 0) {
    return {};
  }
  return failure(ErrorCode::rejected_by_robot,
                 fmt::format("the dashboard server answered \"{}\" to \"{}\"", answer, line));
}

}  // namespace ur_ros_rtde
