#include "controller/tcp_script_socket.hpp"

#include <boost/asio/connect.hpp>
#include <utility>

namespace ur_simulator {

using boost::asio::ip::tcp;
using boost::system::error_code;

std::shared_ptr<TcpScriptSocket> TcpScriptSocket::open(boost::asio::io_context & io, const std::string & host,
                                                       std::uint16_t port, PeerLog log)
{
  const std::shared_ptr<TcpScriptSocket> self(new TcpScriptSocket(io, std::move(log)));
  self->log_.to_peer("connects to {}:{}", host, port);
  // The pending asynchronous operations own the socket.
  self->resolver_.async_resolve(
      host, std::to_string(port),
      [self](const error_code & resolve_error, const tcp::resolver::results_type & endpoints) {
        if (resolve_error) {
          self->fail(resolve_error);
          return;
        }
        boost::asio::async_connect(self->socket_, endpoints,
                                   [self](const error_code & connect_error, const tcp::endpoint &) {
                                     if (connect_error) {
                                       self->fail(connect_error);
                                     } else {
                                       self->start();
                                     }
                                   });
      });
  return self;
}

void TcpScriptSocket::fail(const error_code & error)
{
  failed_ = true;
  log_.note("the connection failed: {}", error.message());
}

void TcpScriptSocket::start()
{
  log_.note("connected");
  connection_ = std::make_shared<Connection>(std::move(socket_), 0, log_);
  connection_->start(
      [this](std::string_view bytes) {
        log_.from_peer("{}", bytes);
        received_.append(bytes);
        connection_->set_reading_paused(received_.size() > unread_limit);
      },
      [this] { failed_ = true; });
}

TcpScriptSocket::~TcpScriptSocket()
{
  error_code ignored;
  resolver_.cancel();
  socket_.close(ignored);
  if (connection_) {
    connection_->close("the program closes the socket");
  }
}

bool TcpScriptSocket::connected() const
{
  return connection_ != nullptr && connection_->is_open();
}

std::string & TcpScriptSocket::received()
{
  if (connection_ && received_.size() <= unread_limit) {
    connection_->set_reading_paused(false);
  }
  return received_;
}

void TcpScriptSocket::send(std::string_view bytes)
{
  if (connection_) {
    log_.to_peer("{}", bytes);
    connection_->send(bytes);
  }
}

}  // namespace ur_simulator
