#pragma once

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include "net/connection.hpp"

namespace ur_simulator::fuzz {

/// A client of the simulator within the process, and the simulator's end of the connection.
class SocketPair {
 public:
  explicit SocketPair(boost::asio::io_context & io)
  {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()) != 0) {
      throw std::system_error(errno, std::generic_category(), "socketpair");
    }
    client_ = ends[0];
    boost::asio::ip::tcp::socket socket(io);
    socket.assign(boost::asio::ip::tcp::v4(), ends[1]);
    connection_ = std::make_shared<Connection>(std::move(socket), 1);
  }
  ~SocketPair()
  {
    connection_->close("the test ends");
    ::close(client_);
  }
  SocketPair(const SocketPair &) = delete;
  SocketPair & operator=(const SocketPair &) = delete;

  const std::shared_ptr<Connection> & connection() const { return connection_; }
  void send(std::string_view bytes) const { (void)::send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL); }
  /// Reads all replies.
  void drain() const
  {
    std::array<char, 65536> replies;
    while (::recv(client_, replies.data(), replies.size(), 0) > 0) {
    }
  }

 private:
  int client_ = -1;
  std::shared_ptr<Connection> connection_;
};

}  // namespace ur_simulator::fuzz
