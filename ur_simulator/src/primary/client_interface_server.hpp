#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "net/listener.hpp"
#include "polyscope/pendant.hpp"
#include "urscript/script_reader.hpp"

namespace ur_simulator::primary {

/// Whether a client interface runs scripts.
enum class ScriptAccess : std::uint8_t { full, read_only };

/// One of the client interfaces: 30001 primary, 30002 secondary, 30003 real-time, or the read-only variant of
/// one: 30011, 30012, 30013 (UR, "Client Interface"). Runs the scripts that clients send and sends them
/// messages. Messages are dropped for clients that do not read; their connections stay open.
class ClientInterfaceServer {
 public:
  /// Returns the messages for a new client; may be null.
  using Greeting = std::function<std::string()>;

  ClientInterfaceServer(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
                        Pendant & pendant, Greeting greeting, ScriptAccess access);
  ~ClientInterfaceServer();

  /// Serves a connection, as each that the listener accepts.
  void accept(const std::shared_ptr<Connection> & connection);
  /// Sends a complete message to each client without unsent data. `name`: in the client log; empty: not
  /// logged.
  void broadcast(std::string_view message, std::string_view name = {});
  Listener & listener() { return listener_; }
  const Listener & listener() const { return listener_; }
  bool has_clients() const { return !clients_.empty(); }

 private:
  struct Client {
    std::shared_ptr<Connection> connection;
    urscript::ScriptReader reader;
    std::uint64_t dropped_scripts = 0;
  };
  void receive(Client & client, std::string_view bytes);
  Pendant::Result run(std::string_view script);
  void log_dropped_scripts(Client & client);

  Pendant & pendant_;
  Greeting greeting_;
  ScriptAccess access_;
  std::map<std::uint64_t, std::shared_ptr<Client>> clients_;
  Listener listener_;
};

}  // namespace ur_simulator::primary
