#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <memory>
#include <string>

#include "dashboard/session.hpp"
#include "net/session_server.hpp"

namespace ur_simulator::dashboard {

/// The dashboard server (UR, "Dashboard Server e-Series" and "Dashboard Server CB-Series").
class Server {
 public:
  Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port, Pendant & pendant);
  /// Serves a connection, as each that the listener accepts.
  void accept(const std::shared_ptr<Connection> & connection) { sessions_.accept(connection); }
  Listener & listener() { return sessions_.listener(); }
  const Listener & listener() const { return sessions_.listener(); }
  /// Sends the pending replies that have become available. Call once per control cycle.
  void cycle();

 private:
  SessionServer<Session> sessions_;
};

}  // namespace ur_simulator::dashboard
