#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <memory>
#include <string>

#include "net/session_server.hpp"
#include "robot_api/session.hpp"

namespace ur_simulator::robot_api {

/// The Robot API of PolyScope X: REST over HTTP. Replaces the dashboard server.
class Server {
 public:
  /// The first version of PolyScope X that has it.
  static constexpr PolyscopeVersion first_version{10, 11, 0, 0};

  Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port, Pendant & pendant,
         const HttpLimits & limits = {});
  /// Serves a connection, as each that the listener accepts.
  void accept(const std::shared_ptr<Connection> & connection) { sessions_.accept(connection); }
  Listener & listener() { return sessions_.listener(); }
  const Listener & listener() const { return sessions_.listener(); }
  /// Sends the replies that have become available. Call once per control cycle.
  void cycle();

 private:
  SessionServer<Session> sessions_;
};

}  // namespace ur_simulator::robot_api
