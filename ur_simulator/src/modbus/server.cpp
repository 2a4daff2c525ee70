#include "modbus/server.hpp"

namespace ur_simulator::modbus {

Server::Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
               ControllerState & state, const PolyscopeVersion & version)
    : ports_(state, version),
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
  const auto client = std::make_shared<Client>(Client{connection, Session(ports_)});
  clients_.emplace(id, client);
  connection->start(
      [weak = std::weak_ptr(client)](std::string_view bytes) {
        const auto locked = weak.lock();  // sending may close the connection
        if (!locked) {
          return;
        }
        const Session::Reply reply = locked->session.receive(bytes, locked->connection->log());
        locked->connection->send(reply.bytes);
        if (!reply.error.empty()) {
          locked->connection->close_after_sending(reply.error);
        }
      },
      [this, id] { clients_.erase(id); });
}

}  // namespace ur_simulator::modbus
