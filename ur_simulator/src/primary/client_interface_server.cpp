#include "primary/client_interface_server.hpp"

#include <fmt/format.h>

#include <utility>

namespace ur_simulator::primary {

ClientInterfaceServer::ClientInterfaceServer(boost::asio::io_context & io, const std::string & address,
                                             std::uint16_t port, Pendant & pendant, Greeting greeting,
                                             ScriptAccess access)
    : pendant_(pendant),
      greeting_(std::move(greeting)),
      access_(access),
      listener_(io, address, port,
                [this](const std::shared_ptr<Connection> & connection) { accept(connection); })
{
}

ClientInterfaceServer::~ClientInterfaceServer()
{
  listener_.close_connections();
}

void ClientInterfaceServer::accept(const std::shared_ptr<Connection> & connection)
{
  const std::uint64_t id = connection->id();
  auto client = std::make_shared<Client>();
  client->connection = connection;
  clients_.emplace(id, client);
  if (greeting_) {
    connection->send(greeting_());
  }
  connection->start(
      [this, weak = std::weak_ptr(client)](std::string_view bytes) {
        if (const auto locked = weak.lock()) {
          receive(*locked, bytes);
        }
      },
      [this, id] { clients_.erase(id); });
}

void ClientInterfaceServer::receive(Client & client, std::string_view bytes)
{
  client.reader.feed(bytes);
  log_dropped_scripts(client);
  while (const auto script = client.reader.next()) {
    // Errors are logged and reported to the clients of the primary interface.
    if (access_ == ScriptAccess::read_only) {
      pendant_.log().error("program", error_codes::read_only_interface,
                           "script was not started: it was sent to a read-only interface");
    } else {
      pendant_.run_script(*script);
    }
  }
}

void ClientInterfaceServer::log_dropped_scripts(Client & client)
{
  const std::uint64_t dropped = client.reader.dropped();
  if (dropped != client.dropped_scripts) {
    client.dropped_scripts = dropped;
    pendant_.log().error("program", fmt::format("a script from {} was dropped: it is too long",
                                                client.connection->remote_endpoint()));
  }
}

void ClientInterfaceServer::broadcast(std::string_view message)
{
  for (auto next = clients_.begin(); next != clients_.end();) {
    const std::shared_ptr<Client> client = (next++)->second;
    client->connection->send_or_drop(message);
  }
}

}  // namespace ur_simulator::primary
