#include "net/line_server.hpp"

#include <utility>

namespace ur_simulator {

LineServer::LineServer(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
                       LineLimit limit, Answer answer)
    : limit_(std::move(limit)),
      answer_(std::move(answer)),
      listener_(io, address, port,
                [this](const std::shared_ptr<Connection> & connection) { accept(connection); })
{
}

LineServer::~LineServer()
{
  listener_.close_connections("the simulator ends");
}

void LineServer::accept(const std::shared_ptr<Connection> & connection)
{
  const std::uint64_t id = connection->id();
  auto client = std::make_shared<Client>(Client{connection, {}});
  clients_.emplace(id, client);
  connection->start(
      [this, weak = std::weak_ptr(client)](std::string_view bytes) {
        if (const auto locked = weak.lock()) {  // sending may close the connection
          receive(*locked, bytes);
        }
      },
      [this, id] { clients_.erase(id); });
}

void LineServer::receive(Client & client, std::string_view bytes)
{
  client.received.append(bytes);
  std::size_t begin = 0;
  for (std::size_t end = client.received.find('\n'); end != std::string::npos && client.connection->is_open();
       end = client.received.find('\n', begin)) {
    const std::string_view line = std::string_view(client.received).substr(begin, end - begin);
    begin = end + 1;
    client.connection->log().from_peer("{}", line);
    const std::string reply = answer_(line, client.connection);
    if (!reply.empty()) {
      client.connection->log().to_peer("{}",
                                       std::string_view(reply).substr(0, reply.find_last_not_of('\n') + 1));
    }
    client.connection->send(reply);
  }
  client.received.erase(0, begin);
  if (client.received.size() > limit_.size) {
    client.connection->send(limit_.reply);
    client.connection->close_after_sending("the line is too long");
  }
}

}  // namespace ur_simulator
