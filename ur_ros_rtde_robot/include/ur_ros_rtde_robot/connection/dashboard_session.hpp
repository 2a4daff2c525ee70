#pragma once

#include <chrono>
#include <optional>
#include <stop_token>
#include <string>

#include "ur_ros_rtde_robot/connection/tcp_socket.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// A connection to the dashboard server for one request after the other, such as a query that is repeated.
/// An e-Series controller applies to each client the control mode, local or remote, at the time of
/// connecting: a new session has the current mode. Not thread-safe.
class DashboardSession {
 public:
  explicit DashboardSession(std::string address) : address_(std::move(address)) {}

  /// Sends a line and returns the answer without the line end. Connects with the first request, after an
  /// error, and if the robot has closed the connection. Errors: link_lost; timeout after `timeout`; canceled
  /// if a stop is requested.
  Expected<std::string> request(const std::string & line, std::chrono::milliseconds timeout,
                                const std::stop_token & stop = {});

  /// For a line that must be sent at most once, and at once: connects, with the errors of request().
  Status connect(std::chrono::milliseconds timeout, const std::stop_token & stop);
  /// Sends a line after connect(). The answer is waited for until `grace` after a stop request.
  Expected<std::string> request_once(const std::string & line, std::chrono::milliseconds timeout,
                                     const std::stop_token & stop, std::chrono::milliseconds grace);

 private:
  struct WaitLimit {
    TcpSocket::Clock::time_point deadline;
    std::stop_token stop;
    std::chrono::milliseconds grace{};
  };
  Status open(const WaitLimit & wait_limit);
  Status greeting(const WaitLimit & wait_limit);
  Status write(const std::string & line, const WaitLimit & wait_limit);
  Expected<std::string> ask(const std::string & line, const WaitLimit & wait_limit);
  Expected<std::string> next_line(WaitLimit wait_limit);

  std::string address_;
  std::optional<TcpSocket> socket_;
  std::string received_;
};

}  // namespace ur_ros_rtde
