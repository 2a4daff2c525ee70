#include "robot_api/server.hpp"

namespace ur_simulator::robot_api {

Server::Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
               Pendant & pendant, const HttpLimits & limits)
    : pendant_(pendant),
      limits_(limits),
      listener_(io, address, port,
                [this](const std::shared_ptr<Connection> & connection) { accept(connection); })
{
}

Server::~Server()
{
  listener_.close_connections("the simulator ends");
}

void Server::accept(const std::shared_ptr<Connection> & connection)
{
  const std::uint64_t id = connection->id();
  auto session = std::make_shared<Session>(connection, pendant_, limits_);
  sessions_.emplace(id, session);
  connection->start(
      [weak = std::weak_ptr(session)](std::string_view bytes) {
        if (const auto locked = weak.lock()) {  // sending may close the connection
          locked->receive(bytes);
        }
      },
      [this, id] { sessions_.erase(id); });
}

void Server::cycle()
{
  // A session that closes removes itself from the map: advance first and keep the session alive.
  for (auto next = sessions_.begin(); next != sessions_.end();) {
    const std::shared_ptr<Session> session = (next++)->second;
    session->cycle();
  }
}

}  // namespace ur_simulator::robot_api
