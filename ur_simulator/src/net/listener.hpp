#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "net/connection.hpp"

namespace ur_simulator {

/// A listening port and the connections that came through it.
class Listener {
 public:
  /// The new client; the callee starts it.
  using OnAccept = std::function<void(const std::shared_ptr<Connection> &)>;

  /// Throws std::runtime_error that names address and port when it cannot be bound. Port 0 takes a free one.
  Listener(boost::asio::io_context & io, const std::string & address, std::uint16_t port, OnAccept on_accept);
  ~Listener();
  Listener(const Listener &) = delete;
  Listener & operator=(const Listener &) = delete;

  std::uint16_t port() const { return endpoint_.port(); }
  std::size_t clients() const;
  /// While not accepting, the port is closed: clients are refused as by a controller that is switched off.
  void set_accepting(bool accepting);
  bool accepting() const { return acceptor_.is_open(); }
  void for_each(const std::function<void(Connection &)> & action);
  void close_all();

 private:
  void listen();
  void accept();
  void accept_later();

  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer retry_;
  boost::asio::ip::tcp::endpoint endpoint_;
  OnAccept on_accept_;
  std::map<std::uint64_t, std::weak_ptr<Connection>> connections_;
  std::uint64_t next_id_ = 1;
};

}  // namespace ur_simulator
