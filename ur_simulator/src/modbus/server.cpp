#include "modbus/server.hpp"

#include <memory>
#include <string_view>
#include <utility>

#include "modbus/session.hpp"

namespace ur_simulator::modbus {

class Server::Client {
 public:
  Client(std::shared_ptr<Connection> connection, PortMap & ports)
      : connection_(std::move(connection)), session_(ports)
  {
  }

  void receive(std::string_view bytes)
  {
    const Session::Reply reply = session_.receive(bytes, connection_->log());
    connection_->send(reply.bytes);
    if (!reply.error.empty()) {
      connection_->close_after_sending(reply.error);
    }
  }

 private:
  std::shared_ptr<Connection> connection_;
  Session session_;
};

Server::Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
               ControllerState & state, const PolyscopeVersion & version)
    : ports_(state, version),
      clients_(io, address, port, [this](const std::shared_ptr<Connection> & connection) {
        return std::make_shared<Client>(connection, ports_);
      })
{
}

}  // namespace ur_simulator::modbus
