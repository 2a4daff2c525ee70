#include "robotiq/robotiq_client.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

namespace ur_ros_rtde_gripper_commands {
namespace {

using ur_ros_rtde::ErrorCode;
using ur_ros_rtde::Expected;
using ur_ros_rtde::failure;
using ur_ros_rtde::Status;
using ur_ros_rtde::TcpSocket;

constexpr std::chrono::seconds answer_timeout{2};
/// Replies have no defined end: "ack" comes without a line end. Silence for this time ends a reply.
constexpr std::chrono::milliseconds end_of_reply{50};
constexpr std::size_t max_reply_size = 1000;

bool is_complete(std::string_view reply)
{
  return reply.ends_with('\n') || reply == "ack";
}

std::string_view without_line_end(std::string_view text)
{
  const auto end = text.find_last_not_of("\r\n");
  return text.substr(0, end == std::string_view::npos ? 0 : end + 1);
}

}  // namespace

Expected<RobotiqClient> RobotiqClient::connect(const std::string & address, std::uint16_t port)
{
  auto socket = TcpSocket::connect(address, port, answer_timeout);
  if (!socket) {
    return failure(
        ErrorCode::not_supported,
        fmt::format("the URCap of the Robotiq gripper cannot be reached ({}): install Robotiq's URCap for "
                    "grippers on the robot, and check that no firewall blocks the port",
                    socket.error().message));
  }
  return RobotiqClient(std::move(*socket));
}

Expected<std::string> RobotiqClient::request(const std::string & line)
{
  const auto deadline = TcpSocket::Clock::now() + answer_timeout;
  if (Status sent = socket_.write(line + "\n", deadline); !sent) {
    return tl::unexpected(sent.error());
  }
  std::string reply;
  std::array<char, 256> buffer{};
  while (!is_complete(reply)) {
    const auto received =
        socket_.read_some(std::as_writable_bytes(std::span(buffer)),
                          reply.empty() ? deadline : TcpSocket::Clock::now() + end_of_reply);
    if (!received && reply.empty()) {
      return tl::unexpected(received.error());
    }
    if (!received) {
      break;  // closed after the reply
    }
    if (*received == 0 && reply.empty()) {
      return failure(ErrorCode::link_lost,
                     fmt::format("the URCap of the Robotiq gripper does not answer `{}`", line));
    }
    if (*received == 0 || reply.size() > max_reply_size) {
      break;
    }
    reply.append(buffer.data(), *received);
  }
  return std::string(without_line_end(reply));
}

Expected<int> RobotiqClient::get(std::string_view name)
{
  const auto reply = request(fmt::format("GET {}", name));
  if (!reply) {
    return tl::unexpected(reply.error());
  }
  std::string_view text = *reply;
  const bool is_named = text.starts_with(name);  // another one is the late answer to another request
  text.remove_prefix(is_named ? name.size() : 0);
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_register = value >= 0 && value <= std::numeric_limits<std::uint8_t>::max();
  if (is_named && is_register && error == std::errc() && end == text.data() + text.size()) {
    return value;
  }
  if (text.starts_with('?')) {
    return failure(ErrorCode::not_ready,
                   "the URCap cannot read the Robotiq gripper: check that the arm is powered on, that the "
                   "gripper is connected, and that the URCap finds it (Installation, URCaps, Gripper)");
  }
  return failure(ErrorCode::rejected_by_robot,
                 fmt::format("the URCap of the Robotiq gripper answers `{}` to `GET {}`: check its version",
                             *reply, name));
}

Status RobotiqClient::set(std::string_view assignments)
{
  const auto reply = request(fmt::format("SET {}", assignments));
  if (!reply) {
    return tl::unexpected(reply.error());
  }
  if (*reply != "ack") {
    return failure(ErrorCode::rejected_by_robot,
                   fmt::format("the URCap of the Robotiq gripper answers `{}` to `SET {}`: check its version",
                               *reply, assignments));
  }
  return {};
}

}  // namespace ur_ros_rtde_gripper_commands
