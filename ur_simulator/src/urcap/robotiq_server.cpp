#include "urcap/robotiq_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

namespace ur_simulator::urcap {
namespace {

constexpr std::size_t max_request_size = 1024;
constexpr int slave_id = 9;  // of the only gripper
constexpr const char * not_understood = "?";

/// What the model does not compute. The versions are those of a recorded gripper.
constexpr std::array<std::pair<std::string_view, const char *>, 12> fixed_values{{{"VST", "0"},
                                                                                  {"COU", "0"},
                                                                                  {"SNU", "C-00000"},
                                                                                  {"PYE", "2019"},
                                                                                  {"NCY", "0"},
                                                                                  {"PON", "0"},
                                                                                  {"NPA", "0"},
                                                                                  {"FWV", "GC3-1.6.9"},
                                                                                  {"VER", "DCU-2.0.0"},
                                                                                  {"DRI", "RUNNING"},
                                                                                  {"DST", "4"},
                                                                                  {"PCO", "0"}}};
/// The scan for grippers and the colors of the light: acknowledged without an effect.
constexpr std::array<std::string_view, 6> ignored{"SCN", "SCN_BLOCK", "LBP", "LRD", "LBL", "LGN"};

int digits(std::string_view name)
{
  return name == "PRE" ? 3 : name == "FLT" ? 2 : 1;
}

std::string_view without_line_end(std::string_view request)
{
  return request.substr(0, request.find_first_of("\r\n"));
}

/// "POS" of "GET POS"; "" of any other request.
std::string_view requested_name(std::string_view request)
{
  return request.starts_with("GET ") ? request.substr(4) : std::string_view();
}

bool assign(RobotiqGripper & gripper, std::string_view name, int value)
{
  if (name == "SID") {
    return gripper.is_powered() && value == slave_id;
  }
  return std::ranges::find(ignored, name) != ignored.end() || gripper.set(name, value);
}

}  // namespace

/// A request ends with its line. A GET of a known variable that arrives without one is complete, too.
class RobotiqServer::Session {
 public:
  Session(std::shared_ptr<Connection> connection, RobotiqServer & server)
      : connection_(std::move(connection)), server_(server)
  {
  }

  void receive(std::string_view bytes)
  {
    received_.append(bytes);
    for (std::size_t size = request_size(); size > 0 && connection_->is_open(); size = request_size()) {
      answer(std::string_view(received_).substr(0, size));
      received_.erase(0, size);
    }
    if (received_.size() > max_request_size) {
      connection_->close("the line is too long");
    }
  }

 private:
  /// 0: incomplete
  std::size_t request_size() const
  {
    const std::size_t end = received_.find('\n');
    if (end != std::string::npos) {
      return end + 1;
    }
    return server_.value(requested_name(received_)) ? received_.size() : 0;
  }

  void answer(std::string_view request)
  {
    const std::string_view text = without_line_end(request);
    const bool late_line_end = text.empty() && line_end_may_follow_;
    line_end_may_follow_ = !request.ends_with('\n');
    if (late_line_end) {
      return;
    }
    connection_->log().from_peer("{}", text);
    const std::string reply = server_.answer(request);
    connection_->log().to_peer("{}", without_line_end(reply));
    connection_->send(reply);
  }

  std::shared_ptr<Connection> connection_;
  RobotiqServer & server_;
  std::string received_;
  bool line_end_may_follow_ = false;  ///< the last request had none
};

RobotiqServer::RobotiqServer(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
                             RobotiqGripper & gripper)
    : gripper_(gripper), sessions_(io, address, port, [this](const std::shared_ptr<Connection> & connection) {
        return std::make_shared<Session>(connection, *this);
      })
{
}

std::string RobotiqServer::answer(std::string_view request)
{
  const bool has_line_end = request.ends_with('\n');
  const std::string_view text = without_line_end(request);
  if (text.starts_with("SET ")) {
    return set(text.substr(4));
  }
  const std::string_view name = requested_name(text);
  const auto found = value(name);
  if (!found) {
    return not_understood;
  }
  return has_line_end ? fmt::format("{} {}\n", name, *found) : *found;
}

std::optional<std::string> RobotiqServer::value(std::string_view name) const
{
  if (name == "SID") {  // of all grippers that are connected
    return gripper_.is_powered() ? fmt::format("[{}]", slave_id) : "[]";
  }
  const auto fixed = std::ranges::find(fixed_values, name, [](const auto & entry) { return entry.first; });
  const auto computed = gripper_.get(name);
  if (fixed == fixed_values.end() && !computed) {
    return std::nullopt;
  }
  if (!gripper_.is_powered()) {
    return "?";
  }
  return computed ? fmt::format("{:0{}}", *computed, digits(name)) : std::string(fixed->second);
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
    if (!assign(changed, name, value)) {
      return not_understood;
    }
  }
  gripper_ = changed;
  return values.empty() ? not_understood : "ack";
}

}  // namespace ur_simulator::urcap
