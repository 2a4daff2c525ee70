#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "net/session_server.hpp"
#include "polyscope/pendant.hpp"
#include "primary/script_session.hpp"

namespace ur_simulator::primary {

/// One of the client interfaces: 30001 primary, 30002 secondary, 30003 real-time, or the read-only variant of
/// one: 30011, 30012, 30013 (UR, "Client Interface"). Runs the scripts that clients send and sends them
/// messages. Messages are dropped for clients that do not read, and for those whose script is read next;
/// their connections stay open.
class ClientInterfaceServer {
 public:
  /// Returns the messages for a new client; may be null.
  using Greeting = std::function<std::string()>;

  ClientInterfaceServer(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
                        Pendant & pendant, const Greeting & greeting, ScriptAccess access);

  /// Serves a connection, as each that the listener accepts.
  void accept(const std::shared_ptr<Connection> & connection) { sessions_.accept(connection); }
  /// Sends a complete message to each client without unsent data. `name`: in the client log; empty: not
  /// logged.
  void broadcast(std::string_view message, std::string_view name = {});
  Listener & listener() { return sessions_.listener(); }
  const Listener & listener() const { return sessions_.listener(); }
  bool has_clients() const { return !sessions_.empty(); }

 private:
  SessionServer<ScriptSession> sessions_;
};

}  // namespace ur_simulator::primary
