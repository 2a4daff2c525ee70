#include "dashboard/server.hpp"

#include <fmt/format.h>

#include "dashboard/commands.hpp"

namespace ur_simulator::dashboard {
namespace {

constexpr std::size_t longest_line = 16 * 1024;

}  // namespace

Server::Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
               Pendant & pendant)
    : pendant_(pendant), listener_(io, address, port, [this](const std::shared_ptr<Connection> & connection) {
        accept(connection);
      })
{
}

Server::~Server()
{
  listener_.close_all();
}

void Server::accept(const std::shared_ptr<Connection> & connection)
{
  const std::uint64_t id = connection->id();
  clients_.emplace(id, Client{connection, {}, pendant_.remote_control(), nullptr});
  connection->send("Connected: Universal Robots Dashboard Server\n");
  connection->start(
      [this, id](std::string_view bytes) {
        if (const auto client = clients_.find(id); client != clients_.end()) {
          receive(client->second, bytes);
        }
      },
      [this, id] { clients_.erase(id); });
}

void Server::receive(Client & client, std::string_view bytes)
{
  // Sending a reply may end the client: only its connection is sure to be there afterwards.
  const std::shared_ptr<Connection> connection = client.connection;
  client.received.append(bytes);
  std::string received = std::move(client.received);
  std::size_t begin = 0;
  for (std::size_t end = received.find('\n'); end != std::string::npos && !client.pending;
       end = received.find('\n', begin)) {
    std::string_view line = std::string_view(received).substr(begin, end - begin);
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    begin = end + 1;
    answer(client, line);
    if (!connection->open()) {
      return;
    }
  }
  if (received.size() - begin > longest_line) {
    pendant_.log().error("dashboard", fmt::format("{} sent a line of more than {} bytes: disconnected",
                                                  connection->peer(), longest_line));
    connection->close();
    return;
  }
  client.received = received.substr(begin);
}

void Server::cycle()
{
  for (auto next = clients_.begin(); next != clients_.end();) {
    Client & client = (next++)->second;
    if (!client.pending) {
      continue;
    }
    // Sending may end the client: only its connection is sure to be there afterwards.
    const std::shared_ptr<Connection> connection = client.connection;
    deliver(client);
    if (connection->open() && !client.pending) {
      receive(client, {});
    }
  }
}

void Server::deliver(Client & client)
{
  if (const auto reply = client.pending()) {
    client.pending = nullptr;
    client.connection->send(*reply + "\n");
  }
}

void Server::answer(Client & client, std::string_view line)
{
  const std::shared_ptr<Connection> connection = client.connection;  // as in receive()
  std::string_view argument;
  const Command * command = find_command(line, pendant_.options().version, argument);
  if (command == nullptr) {
    connection->send(fmt::format("could not understand: '{}'\n", line));
    return;
  }
  const bool local = !pendant_.remote_control() || !client.remote_when_connected;
  if (command->needs_remote_control && local && pendant_.options().version.is_e_series()) {
    connection->send(
        "Command is not allowed due to safety reasons, please switch robot to Remote Control mode and "
        "reconnect to port "
        "29999\n");
    return;
  }
  if (command->begin != nullptr) {
    client.pending = command->begin(pendant_, argument);
    deliver(client);
    return;
  }
  connection->send(command->reply(pendant_, argument) + "\n");
  if (command->name == "quit") {
    connection->close_after_sending();
  }
}

}  // namespace ur_simulator::dashboard
