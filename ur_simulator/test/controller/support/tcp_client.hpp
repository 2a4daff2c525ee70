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

/// A blocking TCP client. All waits have a timeout.
class TcpClient {
 public:
  TcpClient(const std::string & address, std::uint16_t port)
  {
    file_ = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in endpoint{};
    endpoint.sin_family = AF_INET;
    endpoint.sin_port = htons(port);
    inet_pton(AF_INET, address.c_str(), &endpoint.sin_addr);
    if (connect(file_, reinterpret_cast<sockaddr *>(&endpoint), sizeof(endpoint)) != 0) {
      close(file_);
      throw std::runtime_error("connection refused");
    }
    const int yes = 1;
    setsockopt(file_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof(yes));
  }
  ~TcpClient()
  {
    if (file_ >= 0) {
      close(file_);
    }
  }
  TcpClient(const TcpClient &) = delete;
  TcpClient & operator=(const TcpClient &) = delete;

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

  /// Closes the connection with a TCP reset, as after a crash.
  void reset()
  {
    const linger discard{1, 0};
    setsockopt(file_, SOL_SOCKET, SO_LINGER, &discard, sizeof(discard));
    close(std::exchange(file_, -1));
  }

  /// Half-closes the connection. A blocked send() in another thread fails.
  void shut_down_sending() { shutdown(file_, SHUT_WR); }

  /// Returns exactly `count` bytes. Throws std::runtime_error after the timeout or if the connection is
  /// closed.
  std::string receive(std::size_t count, std::chrono::milliseconds timeout = std::chrono::seconds(5))
  {
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    while (received_.size() < count) {
      if (!receive_some(deadline)) {
        throw std::runtime_error("the peer has closed the connection");
      }
    }
    std::string bytes = received_.substr(0, count);
    received_.erase(0, count);
    return bytes;
  }

  /// Returns the next line without its line end.
  std::string receive_line(std::chrono::milliseconds timeout = std::chrono::seconds(5))
  {
    const auto deadline = std::chrono::steady_clock::now() + timeout;
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

  /// Returns whether the peer closes the connection within the timeout. Discards received data.
  bool closed_by_peer(std::chrono::milliseconds timeout = std::chrono::seconds(5))
  {
    const auto deadline = std::chrono::steady_clock::now() + timeout;
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
    const auto remaining =
        std::chrono::duration_cast<milliseconds>(deadline - std::chrono::steady_clock::now());
    pollfd descriptor{file_, POLLIN, 0};
    if (remaining.count() <= 0 || poll(&descriptor, 1, static_cast<int>(remaining.count())) <= 0) {
      throw std::runtime_error("nothing was received within the timeout");
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
