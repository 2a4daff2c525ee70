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

/// A TCP server that receives one request of one client and replies to it. All waits time out after 5 s.
class SingleReplyServer {
 public:
  explicit SingleReplyServer(const std::string & address)
  {
    listener_ = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in endpoint{};
    endpoint.sin_family = AF_INET;
    inet_pton(AF_INET, address.c_str(), &endpoint.sin_addr);
    socklen_t size = sizeof(endpoint);
    if (bind(listener_, reinterpret_cast<sockaddr *>(&endpoint), size) != 0 || listen(listener_, 1) != 0 ||
        getsockname(listener_, reinterpret_cast<sockaddr *>(&endpoint), &size) != 0) {
      close(listener_);
      throw std::runtime_error("cannot listen on " + address);
    }
    port_ = ntohs(endpoint.sin_port);
  }
  ~SingleReplyServer()
  {
    close(listener_);
    if (client_ >= 0) {
      close(client_);
    }
  }
  SingleReplyServer(const SingleReplyServer &) = delete;
  SingleReplyServer & operator=(const SingleReplyServer &) = delete;

  std::uint16_t port() const { return port_; }

  /// Returns the request with its line end; the part received so far, possibly "", after the timeout.
  std::string receive_request()
  {
    if (!wait_readable(listener_)) {
      return {};
    }
    client_ = accept(listener_, nullptr, nullptr);
    std::string text;
    char byte = 0;
    while (wait_readable(client_) && recv(client_, &byte, 1, 0) == 1) {
      text += byte;
      if (byte == '\n') {
        break;
      }
    }
    return text;
  }
  /// Whether the client closes the connection. Received data is discarded.
  bool wait_for_close() const
  {
    char bytes[256];
    while (wait_readable(client_)) {
      if (recv(client_, bytes, sizeof(bytes), 0) <= 0) {
        return true;
      }
    }
    return false;
  }
  /// Leaves the connection open, as ur_rtde does.
  bool send_reply(std::string_view text) const
  {
    return ::send(client_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
  }

 private:
  static bool wait_readable(int file)
  {
    pollfd descriptor{file, POLLIN, 0};
    return poll(&descriptor, 1, 5000) > 0;
  }

  int listener_ = -1;
  int client_ = -1;
  std::uint16_t port_ = 0;
};

}  // namespace ur_simulator::testing
