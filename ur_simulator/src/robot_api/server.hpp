#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "net/listener.hpp"
#include "robot_api/session.hpp"

namespace ur_simulator::robot_api {

/// The Robot API of PolyScope X: REST over HTTP. Replaces the dashboard server.
class Server {
 public:
  /// The first version of PolyScope X that has it.
  static constexpr PolyscopeVersion first_version{10, 11, 0, 0};

  Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port, Pendant & pendant,
         const HttpLimits & limits = {});
  ~Server();
  /// Serves a connection, as each that the listener accepts.
  void accept(const std::shared_ptr<Connection> & connection);
  Listener & listener() { return listener_; }
  const Listener & listener() const { return listener_; }
  /// Sends the replies that have become available. Call once per control cycle.
  void cycle();

 private:
  Pendant & pendant_;
  HttpLimits limits_;
  std::map<std::uint64_t, std::shared_ptr<Session>> sessions_;
  Listener listener_;
};

}  // namespace ur_simulator::robot_api
