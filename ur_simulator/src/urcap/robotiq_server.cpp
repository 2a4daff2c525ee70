#include "urcap/robotiq_server.hpp"

#include <fmt/format.h>

#include <sstream>
#include <utility>
#include <vector>

namespace ur_simulator::urcap {
namespace {

constexpr std::size_t max_line_size = 1024;
constexpr const char * not_understood = "?";

}  // namespace

RobotiqServer::RobotiqServer(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
                             RobotiqGripper & gripper)
    : gripper_(gripper),
      server_(io, address, port, {max_line_size},
              [this](std::string_view line, const auto &) { return answer(line); })
{
}

std::string RobotiqServer::answer(std::string_view line)
{
  if (line.ends_with('\r')) {
    line.remove_suffix(1);
  }
  if (line.starts_with("SET ")) {
    return set(line.substr(4));
  }
  const std::string_view name = line.starts_with("GET ") ? line.substr(4) : std::string_view();
  const auto value = gripper_.get(name);
  if (!value) {
    return not_understood;
  }
  return gripper_.is_powered() ? fmt::format("{} {}\n", name, *value) : fmt::format("{} ?\n", name);
}

std::string RobotiqServer::set(std::string_view assignments)
{
  std::istringstream words{std::string(assignments)};
  std::vector<std::pair<std::string, int>> values;
  for (std::string name; words >> name;) {
    int value = 0;
    if (!(words >> value)) {
      return not_understood;
    }
    values.emplace_back(name, value);
  }
  RobotiqGripper changed = gripper_;
  for (const auto & [name, value] : values) {
    if (!changed.set(name, value)) {
      return not_understood;
    }
  }
  gripper_ = changed;
  return values.empty() ? not_understood : "ack";
}

}  // namespace ur_simulator::urcap
