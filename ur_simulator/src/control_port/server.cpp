#include "control_port/server.hpp"

#include <fmt/format.h>

#include <utility>

namespace ur_simulator::control_port {
namespace {

constexpr std::size_t longest_line = 1024 * 1024;

}  // namespace

Server::Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port, Handler handler)
    : handler_(std::move(handler)),
      listener_(io, address, port,
                [this](const std::shared_ptr<Connection> & connection) { accept(connection); })
{
}

Server::~Server()
{
  listener_.close_all();
}

void Server::accept(const std::shared_ptr<Connection> & connection)
{
  const std::uint64_t id = connection->id();
  auto client = std::make_shared<Client>(Client{connection, {}});
  clients_.emplace(id, client);
  connection->start(
      [this, weak = std::weak_ptr(client)](std::string_view bytes) {
        if (const auto alive = weak.lock()) {
          receive(*alive, bytes);
        }
      },
      [this, id] { clients_.erase(id); });
}

void Server::receive(Client & client, std::string_view bytes)
{
  client.received.append(bytes);
  std::size_t begin = 0;
  for (std::size_t end = client.received.find('\n'); end != std::string::npos && client.connection->open();
       end = client.received.find('\n', begin)) {
    const std::string_view line = std::string_view(client.received).substr(begin, end - begin);
    begin = end + 1;
    if (line.find_first_not_of(" \t\r") != std::string_view::npos) {
      client.connection->send(answer(line) + "\n");
    }
  }
  client.received.erase(0, begin);
  if (client.received.size() > longest_line) {
    client.connection->send(
        fmt::format(R"({{"ok":false,"error":"a line has at most {} bytes"}})", longest_line) + "\n");
    client.connection->close_after_sending();
  }
}

std::string Server::answer(std::string_view line) const
{
  const nlohmann::json request = nlohmann::json::parse(line, nullptr, false);
  const nlohmann::json reply =
      request.is_discarded()
          ? nlohmann::json{{"ok", false}, {"error", "the line is not JSON: one object a line"}}
          : handler_(request);
  // Texts of clients may hold anything: what is not UTF-8 is replaced, not thrown at.
  return reply.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace ur_simulator::control_port
