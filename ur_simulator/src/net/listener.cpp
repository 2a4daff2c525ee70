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

std::string explain(const boost::system::error_code & error, const tcp::endpoint & endpoint)
{
  const std::string where = fmt::format("port {} of {}", endpoint.port(), endpoint.address().to_string());
  if (error == asio::error::address_in_use) {
    return where +
           " is in use by another process: stop it or choose another address (--address) or port (--ports)";
  }
  if (error == asio::error::access_denied) {
    return where + " may not be opened by this user: choose a port above 1023 (--ports)";
  }
  if (error == boost::system::errc::address_not_available) {
    return where + " cannot be opened: no network interface of this machine has that address (--address)";
  }
  return where + " cannot be opened: " + error.message();
}

}  // namespace

Listener::Listener(asio::io_context & io, const std::string & address, std::uint16_t port, OnAccept on_accept)
    : acceptor_(io), retry_(io), on_accept_(std::move(on_accept))
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
  close_all();
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
    throw std::runtime_error(explain(error, endpoint_));
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
      accept_later();
      return;
    }
    const std::uint64_t id = next_id_++;
    auto connection = std::make_shared<Connection>(std::move(socket), id);
    std::erase_if(connections_, [](const auto & entry) { return entry.second.expired(); });
    connections_.emplace(id, connection);
    on_accept_(connection);
    accept();
  });
}

void Listener::accept_later()
{
  // Out of file descriptors, as a rule: at once it would fail again, and again.
  retry_.expires_after(std::chrono::milliseconds(100));
  retry_.async_wait([this](const boost::system::error_code & error) {
    if (!error && acceptor_.is_open()) {
      accept();
    }
  });
}

std::size_t Listener::clients() const
{
  std::size_t count = 0;
  for (const auto & [id, weak] : connections_) {
    const auto connection = weak.lock();
    count += connection && connection->open() ? 1 : 0;
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

void Listener::for_each(const std::function<void(Connection &)> & action)
{
  std::vector<std::shared_ptr<Connection>> open;
  for (const auto & [id, weak] : connections_) {
    if (auto connection = weak.lock(); connection && connection->open()) {
      open.push_back(std::move(connection));
    }
  }
  for (const auto & connection : open) {
    action(*connection);
  }
}

void Listener::close_all()
{
  for_each([](Connection & connection) { connection.close(); });
}

}  // namespace ur_simulator
