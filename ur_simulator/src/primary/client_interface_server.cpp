#include "primary/client_interface_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace ur_simulator::primary {
namespace {

/// Logs the first line of a script, and its size if it has further lines.
void log_script(const PeerLog & log, std::string_view script)
{
  if (!log) {
    return;
  }
  const auto lines = std::ranges::count(script, '\n');
  const std::string_view first_line = script.substr(0, script.find_first_of("\r\n"));
  if (lines <= 1) {
    log.from_peer("{}", first_line);
  } else {
    log.from_peer("script of {} lines, {} bytes: {}", lines, script.size(), first_line);
  }
}

}  // namespace

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
  listener_.close_connections("the simulator ends");
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
    log_script(client.connection->log(), *script);
    if (const Pendant::Result result = run(*script)) {
      client.connection->log().note("accepted");
    } else {
      client.connection->log().note("refused: {}", result.error());
    }
  }
}

Pendant::Result ClientInterfaceServer::run(std::string_view script)
{
  // Errors are logged and reported to the clients of the primary interface.
  if (access_ == ScriptAccess::full) {
    return pendant_.run_script(script);
  }
  constexpr const char * reason = "it was sent to a read-only interface";
  pendant_.log().error("program", error_codes::read_only_interface,
                       fmt::format("script was not started: {}", reason));
  return tl::make_unexpected(reason);
}

void ClientInterfaceServer::log_dropped_scripts(Client & client)
{
  const std::uint64_t dropped = client.reader.dropped();
  if (dropped != client.dropped_scripts) {
    client.dropped_scripts = dropped;
    client.connection->log().note("a script was dropped: it is too long");
    pendant_.log().error("program", fmt::format("a script from {} was dropped: it is too long",
                                                client.connection->remote_endpoint()));
  }
}

void ClientInterfaceServer::broadcast(std::string_view message, std::string_view name)
{
  for (auto next = clients_.begin(); next != clients_.end();) {
    const std::shared_ptr<Client> client = (next++)->second;
    if (client->connection->send_or_drop(message) && !name.empty()) {
      client->connection->log().to_peer("{}", name);
    }
  }
}

}  // namespace ur_simulator::primary
