#include "dashboard/server.hpp"

#include <fmt/format.h>

#include "dashboard/commands.hpp"

namespace ur_simulator::dashboard {
namespace {

constexpr std::size_t max_line_size = 16 * 1024;

void send_reply(Connection & connection, std::string_view reply)
{
  connection.log().to_peer("{}", reply);
  connection.send(fmt::format("{}\n", reply));
}

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
  listener_.close_connections("the simulator ends");
}

void Server::accept(const std::shared_ptr<Connection> & connection)
{
  const std::uint64_t id = connection->id();
  clients_.emplace(id, Client{connection, {}, pendant_.remote_control(), nullptr});
  send_reply(*connection, "Connected: Universal Robots Dashboard Server");
  connection->start(
      [this, id](std::string_view bytes) {
        if (const auto client = clients_.find(id); client != clients_.end()) {
          receive(client->second, bytes);
        }
      },
      [this, id] { clients_.erase(id); });
}

// Sending may close the connection, which destroys the client. The functions below keep the connection alive
// and use the client after sending only if the connection is still open.

void Server::receive(Client & client, std::string_view bytes)
{
  const std::shared_ptr<Connection> connection = client.connection;
  client.received.append(bytes);
  const std::string received = std::move(client.received);
  std::size_t begin = 0;
  for (std::size_t end = received.find('\n'); end != std::string::npos && !client.pending_reply;
       end = received.find('\n', begin)) {
    std::string_view line = std::string_view(received).substr(begin, end - begin);
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    begin = end + 1;
    handle_line(client, line);
    if (!connection->is_open()) {
      return;
    }
  }
  if (received.size() - begin > max_line_size) {
    pendant_.log().error("dashboard", fmt::format("{} sent a line of more than {} bytes: disconnected",
                                                  connection->remote_endpoint(), max_line_size));
    connection->close("the line is too long");
    return;
  }
  client.received = received.substr(begin);
}

void Server::cycle()
{
  for (auto next = clients_.begin(); next != clients_.end();) {
    Client & client = (next++)->second;
    if (!client.pending_reply) {
      continue;
    }
    const std::shared_ptr<Connection> connection = client.connection;
    send_pending_reply(client);
    if (connection->is_open() && !client.pending_reply) {
      receive(client, {});
    }
  }
}

void Server::send_pending_reply(Client & client)
{
  if (const auto reply = client.pending_reply()) {
    client.pending_reply = nullptr;
    send_reply(*client.connection, *reply);
  }
}

bool Server::is_refused(const Client & client, bool requires_remote_control) const
{
  const bool local_control = !pendant_.remote_control() || !client.remote_control_at_connect;
  return requires_remote_control && local_control && pendant_.options().version.is_e_series();
}

void Server::handle_line(Client & client, std::string_view line)
{
  const std::shared_ptr<Connection> connection = client.connection;
  std::string_view argument;
  connection->log().from_peer("{}", line);
  const Command * command = find_command(line, pendant_.options().version, argument);
  if (command == nullptr) {
    send_reply(*connection, fmt::format("could not understand: '{}'", line));
    return;
  }
  if (is_refused(client, command->requires_remote_control)) {
    send_reply(*connection,
               "Command is not allowed due to safety reasons, please switch robot to Remote Control mode and "
               "reconnect to port 29999");
    return;
  }
  if (command->start != nullptr) {
    client.pending_reply = command->start(pendant_, argument);
    send_pending_reply(client);
    return;
  }
  send_reply(*connection, command->execute(pendant_, argument));
  if (command->name == "quit") {
    connection->close_after_sending("quit");
  }
}

}  // namespace ur_simulator::dashboard
