#include "controller/network_socket.hpp"

#include <boost/asio/connect.hpp>
#include <utility>

namespace ur_simulator {

using boost::asio::ip::tcp;
using boost::system::error_code;

std::shared_ptr<NetworkSocket> NetworkSocket::open(boost::asio::io_context & io, const std::string & host,
                                                   std::uint16_t port)
{
  const std::shared_ptr<NetworkSocket> self(new NetworkSocket(io));
  // Connecting keeps the socket alive: it refers to it until it is done.
  self->resolver_.async_resolve(host, std::to_string(port),
                                [self](const error_code & error, const tcp::resolver::results_type & found) {
                                  if (error) {
                                    self->failed_ = true;
                                    return;
                                  }
                                  boost::asio::async_connect(
                                      self->socket_, found,
                                      [self](const error_code & refused, const tcp::endpoint &) {
                                        refused ? self->fail() : self->start();
                                      });
                                });
  return self;
}

void NetworkSocket::start()
{
  connection_ = std::make_shared<Connection>(std::move(socket_), 0);
  connection_->start(
      [this](std::string_view bytes) {
        received_.append(bytes);
        if (received_.size() > unread_limit) {
          connection_->close();
        }
      },
      [this] { failed_ = true; });
}

NetworkSocket::~NetworkSocket()
{
  error_code ignored;
  resolver_.cancel();
  socket_.close(ignored);
  if (connection_) {
    connection_->close();
  }
}

bool NetworkSocket::connected() const
{
  return connection_ != nullptr && connection_->open();
}

void NetworkSocket::send(std::string_view bytes)
{
  if (connection_) {
    connection_->send(bytes);
  }
}

}  // namespace ur_simulator
