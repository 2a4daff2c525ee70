#include "control_port/server.hpp"

#include <fmt/format.h>

#include <utility>

#include "control_port/reply.hpp"
#include "control_port/request_fields.hpp"

namespace ur_simulator::control_port {
namespace {

constexpr std::size_t max_line_size = 1024 * 1024;
constexpr int max_nesting = 16;

/// Parser callback. nlohmann::json is recursive: deep nesting would overflow the stack.
bool reject_deep_nesting(int depth, nlohmann::json::parse_event_t, nlohmann::json &)
{
  if (depth > max_nesting) {
    throw RequestError(fmt::format("the request is nested more than {} levels deep", max_nesting));
  }
  return true;
}

}  // namespace

Server::Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
               RequestHandler handle_request)
    : handle_request_(std::move(handle_request)),
      listener_(io, address, port,
                [this](const std::shared_ptr<Connection> & connection) { accept(connection); })
{
}

Server::~Server()
{
  listener_.close_connections();
}

void Server::accept(const std::shared_ptr<Connection> & connection)
{
  const std::uint64_t id = connection->id();
  auto client = std::make_shared<Client>(Client{connection, {}});
  clients_.emplace(id, client);
  connection->start(
      [this, weak = std::weak_ptr(client)](std::string_view bytes) {
        if (const auto locked = weak.lock()) {
          receive(*locked, bytes);
        }
      },
      [this, id] { clients_.erase(id); });
}

void Server::receive(Client & client, std::string_view bytes)
{
  client.received.append(bytes);
  std::size_t begin = 0;
  for (std::size_t end = client.received.find('\n'); end != std::string::npos && client.connection->is_open();
       end = client.received.find('\n', begin)) {
    const std::string_view line = std::string_view(client.received).substr(begin, end - begin);
    begin = end + 1;
    if (line.find_first_not_of(" \t\r") != std::string_view::npos) {
      client.connection->send(reply_to(line) + "\n");
    }
  }
  client.received.erase(0, begin);
  if (client.received.size() > max_line_size) {
    client.connection->send(error_reply(fmt::format("a line has at most {} bytes", max_line_size)).dump() +
                            "\n");
    client.connection->close_after_sending();
  }
}

std::string Server::reply_to(std::string_view line) const
{
  nlohmann::json reply;
  try {
    const nlohmann::json request = nlohmann::json::parse(line, reject_deep_nesting, false);
    reply = request.is_discarded() ? error_reply("the line is not JSON: send one object per line")
                                   : handle_request_(request);
  } catch (const RequestError & error) {
    reply = error_reply(error.what());
  }
  // Strings of clients may contain invalid UTF-8: dump() replaces it instead of throwing.
  return reply.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace ur_simulator::control_port
