#include "connection/dashboard_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "connection/ports.hpp"
#include "ur_ros_rtde_robot/connection/tcp_socket.hpp"
#include "ur_ros_rtde_robot/connection/text.hpp"

namespace ur_ros_rtde {
namespace {

using Clock = TcpSocket::Clock;
constexpr std::chrono::milliseconds connect_limit{5000};
constexpr std::chrono::milliseconds poll_interval{50};
constexpr std::size_t longest_answer = 64 * 1024;

struct WaitLimit {
  Clock::time_point deadline;
  std::stop_token stop;
};

/// Removes the first line from `received` and returns it, reading from `socket` until there is one.
Expected<std::string> next_line(TcpSocket & socket, std::string & received, const WaitLimit & wait_limit)
{
  std::array<std::byte, 512> bytes;
  for (auto end = received.find('\n'); true; end = received.find('\n')) {
    if (end != std::string::npos) {
      std::string line = received.substr(0, end);
      received.erase(0, end + 1);
      line.erase(line.find_last_not_of(" \t\r") + 1);
      return printable(line);
    }
    if (wait_limit.stop.stop_requested()) {
      return failure(ErrorCode::canceled, "the request to the dashboard server was canceled");
    }
    const auto now = Clock::now();
    if (now >= wait_limit.deadline) {
      return failure(ErrorCode::timeout, "the dashboard server has not answered");
    }
    const auto got = socket.read_some(bytes, std::min(wait_limit.deadline, now + poll_interval));
    if (!got) {
      return tl::unexpected(got.error());
    }
    received.append(reinterpret_cast<const char *>(bytes.data()), *got);
    if (received.size() > longest_answer) {
      return failure(
          ErrorCode::link_lost,
          fmt::format("the dashboard server sent {} bytes without an end of line", received.size()));
    }
  }
}

}  // namespace

Expected<std::string> dashboard_request(const std::string & address, const std::string & line,
                                        std::chrono::milliseconds limit, const std::stop_token & stop)
{
  const auto begin = Clock::now();
  auto socket = TcpSocket::connect(address, dashboard_port, std::min(limit, connect_limit));
  if (!socket) {
    return tl::unexpected(socket.error());
  }
  std::string received;
  if (const auto greeting = next_line(*socket, received, {begin + limit, stop}); !greeting) {
    return greeting;
  }
  if (const auto sent = socket->write(line + "\n", begin + limit); !sent) {
    return tl::unexpected(sent.error());
  }
  return next_line(*socket, received, {begin + limit, stop});
}

Status stop_program(const std::string & address)
{
  constexpr std::chrono::milliseconds timeout{500};
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
