#include "primary/client_interface_server.hpp"

#include <utility>

namespace ur_simulator::primary {

ClientInterfaceServer::ClientInterfaceServer(boost::asio::io_context & io, const std::string & address,
                                             std::uint16_t port, Pendant & pendant, const Greeting & greeting,
                                             ScriptAccess access)
    : sessions_(io, address, port,
                [&pendant, greeting, access](const std::shared_ptr<Connection> & connection) {
                  if (greeting) {
                    connection->send(greeting());
                  }
                  return std::make_shared<ScriptSession>(connection, pendant, access);
                })
{
}

void ClientInterfaceServer::broadcast(std::string_view message, std::string_view name)
{
  sessions_.for_each([&](ScriptSession & session) {
    Connection & connection = session.connection();
    if (!connection.has_unread_data() && connection.send_or_drop(message) && !name.empty()) {
      connection.log().to_peer("{}", name);
    }
  });
}

}  // namespace ur_simulator::primary
