#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace ur_simulator::testing {

/// A blocking TCP client whose every wait has a limit.
class RawSocket {
 public:
  RawSocket(const std::string & address, std::uint16_t port)
  {
    file_ = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    inet_pton(AF_INET, address.c_str(), &to.sin_addr);
    if (connect(file_, reinterpret_cast<sockaddr *>(&to), sizeof(to)) != 0) {
      close(file_);
      throw std::runtime_error("connection refused");
    }
    const int yes = 1;
    setsockopt(file_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof(yes));
  }
  ~RawSocket()
  {
    if (file_ >= 0) {
      close(file_);
    }
  }
  RawSocket(const RawSocket &) = delete;
  RawSocket & operator=(const RawSocket &) = delete;

  void send(std::string_view bytes)
  {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(file_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent < 0) {
        throw std::runtime_error("the peer has closed the connection");
      }
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
  }

  /// Ends the connection as a crashed client would.
  void reset()
  {
    const linger at_once{1, 0};
    setsockopt(file_, SOL_SOCKET, SO_LINGER, &at_once, sizeof(at_once));
    close(std::exchange(file_, -1));
  }

  /// Exactly so many bytes; throws when they do not come within the limit or the connection ends.
  std::string receive(std::size_t count, std::chrono::milliseconds limit = std::chrono::seconds(5))
  {
    const auto deadline = std::chrono::steady_clock::now() + limit;
    while (received_.size() < count) {
      if (!receive_some(deadline)) {
        throw std::runtime_error("the peer has closed the connection");
      }
    }
    std::string taken = received_.substr(0, count);
    received_.erase(0, count);
    return taken;
  }

  /// Up to and without the next line end.
  std::string receive_line(std::chrono::milliseconds limit = std::chrono::seconds(5))
  {
    const auto deadline = std::chrono::steady_clock::now() + limit;
    std::size_t end = received_.find('\n');
    while (end == std::string::npos) {
      if (!receive_some(deadline)) {
        throw std::runtime_error("the peer has closed the connection");
      }
      end = received_.find('\n');
    }
    std::string line = received_.substr(0, end);
    received_.erase(0, end + 1);
    return line;
  }

  /// Does the peer end the connection within the limit? What still comes is thrown away.
  bool closed_by_peer(std::chrono::milliseconds limit = std::chrono::seconds(5))
  {
    const auto deadline = std::chrono::steady_clock::now() + limit;
    try {
      while (receive_some(deadline)) {
      }
      return true;
    } catch (const std::runtime_error &) {
      return false;
    }
  }

 private:
  bool receive_some(std::chrono::steady_clock::time_point deadline)
  {
    using std::chrono::milliseconds;
    const auto left = std::chrono::duration_cast<milliseconds>(deadline - std::chrono::steady_clock::now());
    pollfd poll_for{file_, POLLIN, 0};
    if (left.count() <= 0 || poll(&poll_for, 1, static_cast<int>(left.count())) <= 0) {
      throw std::runtime_error("nothing came within the limit");
    }
    char buffer[4096];
    const ssize_t count = recv(file_, buffer, sizeof(buffer), 0);
    if (count <= 0) {
      return false;
    }
    received_.append(buffer, static_cast<std::size_t>(count));
    return true;
  }

  int file_ = -1;
  std::string received_;
};

}  // namespace ur_simulator::testing
