#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <memory>
#include <string>

#include "net/connection.hpp"
#include "script_api/script_socket.hpp"

namespace ur_simulator {

/// A program's socket on the real network. Limits: 256 KiB unsent (then it is closed), 1 MiB unread
/// (likewise).
class NetworkSocket final : public ScriptSocket {
 public:
  static std::shared_ptr<NetworkSocket> open(boost::asio::io_context & io, const std::string & host,
                                             std::uint16_t port);
  ~NetworkSocket() override;
  NetworkSocket(const NetworkSocket &) = delete;
  NetworkSocket & operator=(const NetworkSocket &) = delete;

  bool connected() const override;
  bool failed() const override { return failed_; }
  void send(std::string_view bytes) override;
  std::string & received() override { return received_; }

 private:
  explicit NetworkSocket(boost::asio::io_context & io) : resolver_(io), socket_(io) {}
  void start();
  void fail() { failed_ = true; }

  static constexpr std::size_t unread_limit = 1024 * 1024;

  boost::asio::ip::tcp::resolver resolver_;
  boost::asio::ip::tcp::socket socket_;
  std::shared_ptr<Connection> connection_;
  std::string received_;
  bool failed_ = false;
};

}  // namespace ur_simulator
