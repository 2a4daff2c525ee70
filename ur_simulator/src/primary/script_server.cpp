#include "primary/script_server.hpp"

#include <fmt/format.h>

#include <utility>

namespace ur_simulator::primary {

ScriptServer::ScriptServer(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
                           Pendant & pendant, std::string greeting)
    : pendant_(pendant),
      greeting_(std::move(greeting)),
      listener_(io, address, port,
                [this](const std::shared_ptr<Connection> & connection) { accept(connection); })
{
}

ScriptServer::~ScriptServer()
{
  listener_.close_all();
}

void ScriptServer::accept(const std::shared_ptr<Connection> & connection)
{
  const std::uint64_t id = connection->id();
  auto client = std::make_shared<Client>();
  client->connection = connection;
  clients_.emplace(id, client);
  connection->send(greeting_);
  connection->start(
      [this, weak = std::weak_ptr(client)](std::string_view bytes) {
        if (const auto alive = weak.lock()) {
          receive(*alive, bytes);
        }
      },
      [this, id] { clients_.erase(id); });
}

void ScriptServer::receive(Client & client, std::string_view bytes)
{
  client.reader.feed(bytes);
  report_dropped(client);
  while (const auto script = client.reader.next()) {
    // A refusal is in the log and reaches the clients as an error message.
    pendant_.run_script(*script);
  }
}

void ScriptServer::report_dropped(Client & client)
{
  const std::uint64_t dropped = client.reader.dropped();
  if (dropped != client.dropped) {
    client.dropped = dropped;
    pendant_.log().error(
        "program", fmt::format("a script from {} was dropped: it is too long", client.connection->peer()));
  }
}

void ScriptServer::broadcast(std::string_view message)
{
  for (auto next = clients_.begin(); next != clients_.end();) {
    const std::shared_ptr<Client> client = (next++)->second;
    client->connection->send_or_drop(message);
  }
}

}  // namespace ur_simulator::primary
