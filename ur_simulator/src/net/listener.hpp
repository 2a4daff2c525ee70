#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "net/connection.hpp"

namespace ur_simulator {

/// The process may not open this port: those below 1024 usually need privileges.
class PortNotPermitted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A listening TCP port and the connections accepted on it. Connections beyond `max_connections` are closed
/// at once, so that a client that opens connections in a loop does not use up the file descriptors of the
/// process.
class Listener {
 public:
  static constexpr std::size_t max_connections = 50;

  /// Receives each new connection and calls Connection::start().
  using AcceptHandler = std::function<void(const std::shared_ptr<Connection> &)>;

  /// Port 0 selects a free port. Throws std::runtime_error with address and port if the port cannot be bound;
  /// PortNotPermitted if privileges are missing.
  Listener(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
           AcceptHandler on_accept);
  ~Listener();
  Listener(const Listener &) = delete;
  Listener & operator=(const Listener &) = delete;

  /// Clients that connect from now on are participants of the log, as clients of this kind.
  void set_client_log(ClientLog & log, std::string kind);
  std::uint16_t port() const { return endpoint_.port(); }
  /// Number of open connections.
  std::size_t connection_count() const;
  /// While accepting is off, the port is closed and clients are refused, as by a controller without power.
  void set_accepting(bool accepting);
  void for_each_connection(const std::function<void(Connection &)> & action);
  void close_connections(std::string_view reason);

 private:
  void listen();
  void accept();
  void serve(boost::asio::ip::tcp::socket socket);
  void retry_accept();

  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer retry_timer_;
  boost::asio::ip::tcp::endpoint endpoint_;
  AcceptHandler on_accept_;
  ClientLog * client_log_ = nullptr;
  std::string client_kind_;
  std::map<std::uint64_t, std::weak_ptr<Connection>> connections_;
  std::uint64_t next_id_ = 1;
};

}  // namespace ur_simulator
