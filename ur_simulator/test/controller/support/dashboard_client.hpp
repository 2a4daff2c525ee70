#pragma once

#include <string>

#include "raw_socket.hpp"

namespace ur_simulator::testing {

/// Asks the Dashboard Server line by line.
class DashboardClient {
 public:
  explicit DashboardClient(const std::string & address) : socket_(address, 29999)
  {
    greeting = socket_.receive_line();
  }
  std::string ask(const std::string & command, std::chrono::milliseconds limit = std::chrono::seconds(5))
  {
    socket_.send(command + "\n");
    return socket_.receive_line(limit);
  }
  RawSocket & socket() { return socket_; }
  std::string greeting;

 private:
  RawSocket socket_;
};

}  // namespace ur_simulator::testing
