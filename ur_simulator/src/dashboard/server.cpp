#include "dashboard/server.hpp"

namespace ur_simulator::dashboard {

Server::Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
               Pendant & pendant)
    : sessions_(io, address, port, [&pendant](const std::shared_ptr<Connection> & connection) {
        return std::make_shared<Session>(connection, pendant);
      })
{
}

void Server::cycle()
{
  sessions_.for_each([](Session & session) { session.cycle(); });
}

}  // namespace ur_simulator::dashboard
