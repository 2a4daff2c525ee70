#include "app/status_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "client_log/text.hpp"

namespace ur_simulator {
namespace {

using nlohmann::json;

constexpr std::size_t error_limit = 200;  // bytes

std::string modes(const json & state)
{
  const json & program = state.at("program");
  const auto name = program.at("name").get<std::string>();
  return fmt::format("{}, {}, program {}{}", state.at("robot_mode").get<std::string>(),
                     state.at("safety_mode").get<std::string>(), name.empty() ? "" : name + " ",
                     program.at("state").get<std::string>());
}

std::string joints(const json & state)
{
  std::string text = "joints";
  for (const double position : state.at("actual").at("position")) {
    text += fmt::format(" {:6.1f}", position * 180.0 / std::numbers::pi);
  }
  return text + " deg";
}

std::string tcp_speed(const json & state)
{
  const json & speed = state.at("actual_tcp_speed");
  return fmt::format("TCP {:.3f} m/s",
                     std::hypot(speed[0].get<double>(), speed[1].get<double>(), speed[2].get<double>()));
}

std::string clients(const json & state)
{
  std::string text;
  for (const auto & [port, count] : state.at("clients").items()) {
    if (count > 0 && !port.starts_with("rtde_")) {  // these are some of the clients of "rtde"
      text += fmt::format("{}{} {}", text.empty() ? "clients: " : ", ", port, count.get<int>());
    }
  }
  return text.empty() ? "no clients" : text;
}

std::string timing(const RobotStatus & status)
{
  return fmt::format("{:.1f} s, {:.2f} x real time, {} missed cycles",
                     status.state.at("timestamp").get<double>(), status.real_time_factor,
                     status.state.at("missed_cycles").get<std::uint64_t>());
}

std::string last_error(const RobotStatus & status)
{
  return status.last_error.empty() ? "no error" : "last error: " + printable(status.last_error, error_limit);
}

}  // namespace

std::string describe_state(const RobotStatus & status)
{
  return fmt::format("{}; {}; {}", modes(status.state), clients(status.state), last_error(status));
}

std::vector<std::string> status_lines(const std::vector<RobotStatus> & robots, std::size_t columns,
                                      std::size_t rows)
{
  std::vector<std::string> lines;
  for (const RobotStatus & robot : robots) {
    const std::string head = robot.address + ": " + modes(robot.state);
    const std::string motion = fmt::format("{}, {}", joints(robot.state), tcp_speed(robot.state));
    const std::string service = fmt::format("{}; {}", clients(robot.state), timing(robot));
    if (robots.size() == 1) {
      lines = {head, motion, service, last_error(robot)};
    } else {
      lines.push_back(fmt::format("{}; {}; {}; {}", head, service, motion, last_error(robot)));
    }
  }
  if (lines.size() > rows) {
    const std::size_t hidden = lines.size() - rows + 1;
    lines.resize(rows - 1);
    lines.push_back(fmt::format("and {} more", hidden));
  }
  for (std::string & line : lines) {
    line.resize(std::min(line.size(), columns));
  }
  return lines;
}

}  // namespace ur_simulator
