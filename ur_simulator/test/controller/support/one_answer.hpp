#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace ur_simulator::testing {

/// A server for one client: takes its request and answers; every wait has a limit.
class OneAnswer {
 public:
  explicit OneAnswer(const std::string & address)
  {
    listener_ = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in at{};
    at.sin_family = AF_INET;
    inet_pton(AF_INET, address.c_str(), &at.sin_addr);
    socklen_t size = sizeof(at);
    if (bind(listener_, reinterpret_cast<sockaddr *>(&at), size) != 0 || listen(listener_, 1) != 0 ||
        getsockname(listener_, reinterpret_cast<sockaddr *>(&at), &size) != 0) {
      close(listener_);
      throw std::runtime_error("cannot listen on " + address);
    }
    port_ = ntohs(at.sin_port);
  }
  ~OneAnswer()
  {
    close(listener_);
    if (client_ >= 0) {
      close(client_);
    }
  }
  OneAnswer(const OneAnswer &) = delete;
  OneAnswer & operator=(const OneAnswer &) = delete;

  std::uint16_t port() const { return port_; }

  /// The request up to its line end; "" when none comes.
  std::string request()
  {
    if (!readable(listener_)) {
      return {};
    }
    client_ = accept(listener_, nullptr, nullptr);
    std::string text;
    char byte = 0;
    while (readable(client_) && recv(client_, &byte, 1, 0) == 1) {
      text += byte;
      if (byte == '\n') {
        break;
      }
    }
    return text;
  }
  /// The connection stays open, as ur_rtde leaves it.
  bool answer(std::string_view text) const
  {
    return ::send(client_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
  }

 private:
  static bool readable(int file)
  {
    pollfd waiting{file, POLLIN, 0};
    return poll(&waiting, 1, 5000) > 0;
  }

  int listener_ = -1;
  int client_ = -1;
  std::uint16_t port_ = 0;
};

}  // namespace ur_simulator::testing
