#include "robot_api/server.hpp"

namespace ur_simulator::robot_api {

Server::Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
               Pendant & pendant, const HttpLimits & limits)
    : sessions_(io, address, port, [&pendant, limits](const std::shared_ptr<Connection> & connection) {
        return std::make_shared<Session>(connection, pendant, limits);
      })
{
}

void Server::cycle()
{
  sessions_.for_each([](Session & session) { session.cycle(); });
}

}  // namespace ur_simulator::robot_api
