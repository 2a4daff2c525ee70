#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "net/connection.hpp"
#include "script_api/script_socket.hpp"

namespace ur_simulator {

/// The TCP connection of a program's socket. Closed if more than 256 KiB are unsent. A peer that sends faster
/// than the program reads is slowed down by TCP.
class TcpScriptSocket final : public ScriptSocket {
 public:
  static std::shared_ptr<TcpScriptSocket> open(boost::asio::io_context & io, const std::string & host,
                                               std::uint16_t port, PeerLog log);
  ~TcpScriptSocket() override;
  TcpScriptSocket(const TcpScriptSocket &) = delete;
  TcpScriptSocket & operator=(const TcpScriptSocket &) = delete;

  bool connected() const override;
  bool failed() const override { return failed_; }
  void send(std::string_view bytes) override;
  std::string & received() override;

 private:
  TcpScriptSocket(boost::asio::io_context & io, PeerLog log)
      : resolver_(io), socket_(io), log_(std::move(log))
  {
  }
  void start();
  void fail(const boost::system::error_code & error);

  static constexpr std::size_t unread_limit = 64 * 1024;  ///< reading pauses above it

  boost::asio::ip::tcp::resolver resolver_;
  boost::asio::ip::tcp::socket socket_;
  PeerLog log_;
  std::shared_ptr<Connection> connection_;
  std::string received_;
  bool failed_ = false;
};

}  // namespace ur_simulator
