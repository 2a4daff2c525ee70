#include "ur_ros_rtde_robot/connection/dashboard_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "connection/ports.hpp"
#include "ur_ros_rtde_robot/connection/text.hpp"

namespace ur_ros_rtde {
namespace {

using Clock = TcpSocket::Clock;
constexpr std::chrono::milliseconds connect_timeout{5000};
constexpr std::chrono::milliseconds poll_interval{50};
constexpr std::size_t max_answer_size = 64 * 1024;

}  // namespace

Expected<std::string> DashboardSession::next_line(WaitLimit wait_limit)
{
  std::array<std::byte, 512> bytes;
  for (auto end = received_.find('\n'); true; end = received_.find('\n')) {
    if (end != std::string::npos) {
      std::string line = received_.substr(0, end);
      received_.erase(0, end + 1);
      line.erase(line.find_last_not_of(" \t\r") + 1);
      return printable(line);
    }
    const auto now = Clock::now();
    if (wait_limit.stop.stop_requested()) {
      if (wait_limit.grace == std::chrono::milliseconds::zero()) {
        return failure(ErrorCode::canceled, "the request to the dashboard server was canceled");
      }
      wait_limit = {
          .deadline = std::min(wait_limit.deadline, now + wait_limit.grace), .stop = {}, .grace = {}};
    }
    if (now >= wait_limit.deadline) {
      return failure(ErrorCode::timeout, "the dashboard server has not answered");
    }
    const auto got = socket_->read_some(bytes, std::min(wait_limit.deadline, now + poll_interval));
    if (!got) {
      return tl::unexpected(got.error());
    }
    received_.append(reinterpret_cast<const char *>(bytes.data()), *got);
    if (received_.size() > max_answer_size) {
      return failure(
          ErrorCode::link_lost,
          fmt::format("the dashboard server sent {} bytes without an end of line", received_.size()));
    }
  }
}

Status DashboardSession::open(const WaitLimit & wait_limit)
{
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(wait_limit.deadline - Clock::now());
  auto socket = TcpSocket::connect(address_, dashboard_port, std::min(left, connect_timeout));
  if (!socket) {
    return tl::unexpected(socket.error());
  }
  socket_ = std::move(*socket);
  received_.clear();
  return {};
}

Status DashboardSession::write(const std::string & line, const WaitLimit & wait_limit)
{
  return socket_->write(line + "\n", wait_limit.deadline);
}

Status DashboardSession::greeting(const WaitLimit & wait_limit)
{
  return next_line(wait_limit).map([](const std::string &) {});
}

/// Does not wait for the greeting before it sends: a busy controller may greet late.
Expected<std::string> DashboardSession::ask(const std::string & line, const WaitLimit & wait_limit)
{
  const bool is_new = !socket_ || !received_.empty();  // what has arrived does not answer this request
  Status sent = is_new ? open(wait_limit) : Status();
  if (sent) {
    sent = write(line, wait_limit);
  }
  if (sent && is_new) {
    sent = greeting(wait_limit);
  }
  auto answer = sent ? next_line(wait_limit) : Expected<std::string>(tl::unexpected(sent.error()));
  if (!answer) {
    socket_.reset();
  }
  return answer;
}

Expected<std::string> DashboardSession::request(const std::string & line, std::chrono::milliseconds timeout,
                                                const std::stop_token & stop)
{
  const WaitLimit wait_limit{Clock::now() + timeout, stop};
  const bool was_connected = socket_.has_value();
  auto answer = ask(line, wait_limit);
  if (!answer && was_connected && answer.error().code == ErrorCode::link_lost) {
    return ask(line, wait_limit);  // the robot has closed the connection since the last request
  }
  return answer;
}

Status DashboardSession::connect(std::chrono::milliseconds timeout, const std::stop_token & stop)
{
  const WaitLimit wait_limit{Clock::now() + timeout, stop};
  const Status opened = open(wait_limit);
  return opened ? greeting(wait_limit) : opened;
}

Expected<std::string> DashboardSession::request_once(const std::string & line,
                                                     std::chrono::milliseconds timeout,
                                                     const std::stop_token & stop,
                                                     std::chrono::milliseconds grace)
{
  const WaitLimit wait_limit{Clock::now() + timeout, stop, grace};
  const Status sent = write(line, wait_limit);
  return sent ? next_line(wait_limit) : tl::unexpected(sent.error());
}

}  // namespace ur_ros_rtde
