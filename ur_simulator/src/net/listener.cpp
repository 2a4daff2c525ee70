#include "net/listener.hpp"

#include <fmt/format.h>

#include <boost/asio/ip/address.hpp>
#include <chrono>
#include <stdexcept>
#include <utility>
#include <vector>

namespace ur_simulator {
namespace asio = boost::asio;
using asio::ip::tcp;

namespace {

std::string describe_bind_error(const boost::system::error_code & error, const tcp::endpoint & endpoint)
{
  const std::string where = fmt::format("port {} of {}", endpoint.port(), endpoint.address().to_string());
  if (error == asio::error::address_in_use) {
    return where +
           " is in use by another process: stop that process or select another address (--address) or port "
           "(--ports)";
  }
  if (error == asio::error::access_denied) {
    return where +
           " cannot be opened without privileges: select a port above 1023, such as "
           "--ports robot_api=8080 or --ports modbus=1502";
  }
  if (error == boost::system::errc::address_not_available) {
    return where + " cannot be opened: no network interface of this machine has this address (--address)";
  }
  return where + " cannot be opened: " + error.message();
}

}  // namespace

Listener::Listener(asio::io_context & io, const std::string & address, std::uint16_t port,
                   AcceptHandler on_accept)
    : acceptor_(io), retry_timer_(io), on_accept_(std::move(on_accept))
{
  boost::system::error_code error;
  const asio::ip::address parsed = asio::ip::make_address(address, error);
  if (error) {
    throw std::runtime_error(
        fmt::format("address '{}' is not an IP address (--address): {}", address, error.message()));
  }
  endpoint_ = tcp::endpoint(parsed, port);
  listen();
}

Listener::~Listener()
{
  close_connections("the simulator ends");
}

void Listener::set_client_log(ClientLog & log, std::string kind)
{
  client_log_ = &log;
  client_kind_ = std::move(kind);
}

void Listener::listen()
{
  boost::system::error_code error;
  acceptor_.open(endpoint_.protocol(), error);
  if (!error) {
    acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
  }
  if (!error) {
    acceptor_.bind(endpoint_, error);
  }
  if (!error) {
    acceptor_.listen(asio::socket_base::max_listen_connections, error);
  }
  if (error) {
    boost::system::error_code ignored;
    acceptor_.close(ignored);
    const std::string message = describe_bind_error(error, endpoint_);
    if (error == asio::error::access_denied) {
      throw PortNotPermitted(message);
    }
    throw std::runtime_error(message);
  }
  endpoint_ = acceptor_.local_endpoint();
  accept();
}

void Listener::accept()
{
  acceptor_.async_accept([this](const boost::system::error_code & error, tcp::socket socket) {
    if (error == asio::error::operation_aborted || !acceptor_.is_open()) {
      return;
    }
    if (error) {
      retry_accept();
      return;
    }
    std::erase_if(connections_, [](const auto & entry) { return entry.second.expired(); });
    serve(std::move(socket));
    accept();
  });
}

void Listener::serve(tcp::socket socket)
{
  auto connection = std::make_shared<Connection>(
      std::move(socket), next_id_, client_log_ != nullptr ? client_log_->add_peer(client_kind_) : PeerLog());
  connection->log().from_peer("connects from {}", connection->remote_endpoint());
  if (connection_count() >= max_connections) {
    connection->close("too many clients");
    return;
  }
  connections_.emplace(next_id_++, connection);
  on_accept_(connection);
}

void Listener::retry_accept()
{
  // The usual cause is a lack of file descriptors. An immediate retry would fail again.
  retry_timer_.expires_after(std::chrono::milliseconds(100));
  retry_timer_.async_wait([this](const boost::system::error_code & error) {
    if (!error && acceptor_.is_open()) {
      accept();
    }
  });
}

std::size_t Listener::connection_count() const
{
  std::size_t count = 0;
  for (const auto & [id, weak] : connections_) {
    const auto connection = weak.lock();
    count += connection && connection->is_open() ? 1 : 0;
  }
  return count;
}

void Listener::set_accepting(bool accepting)
{
  if (accepting == acceptor_.is_open()) {
    return;
  }
  if (accepting) {
    listen();
    return;
  }
  boost::system::error_code ignored;
  acceptor_.close(ignored);
}

void Listener::for_each_connection(const std::function<void(Connection &)> & action)
{
  std::vector<std::shared_ptr<Connection>> open;
  for (const auto & [id, weak] : connections_) {
    if (auto connection = weak.lock(); connection && connection->is_open()) {
      open.push_back(std::move(connection));
    }
  }
  for (const auto & connection : open) {
    action(*connection);
  }
}

void Listener::close_connections(std::string_view reason)
{
  for_each_connection([reason](Connection & connection) { connection.close(reason); });
}

}  // namespace ur_simulator
