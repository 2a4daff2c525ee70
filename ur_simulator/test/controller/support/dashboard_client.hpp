#pragma once

#include <string>

#include "tcp_client.hpp"

namespace ur_simulator::testing {

/// A client of the dashboard server.
class DashboardClient {
 public:
  explicit DashboardClient(const std::string & address) : socket_(address, 29999)
  {
    greeting = socket_.receive_line();
  }
  /// Sends a command and returns the reply.
  std::string request(const std::string & command,
                      std::chrono::milliseconds timeout = std::chrono::seconds(5))
  {
    socket_.send(command + "\n");
    return socket_.receive_line(timeout);
  }
  TcpClient & socket() { return socket_; }
  std::string greeting;

 private:
  TcpClient socket_;
};

}  // namespace ur_simulator::testing
