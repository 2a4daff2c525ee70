#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "net/listener.hpp"
#include "polyscope/pendant.hpp"
#include "urscript/script_reader.hpp"

namespace ur_simulator::primary {

/// One of the ports that take scripts (30001 primary, 30002 secondary, 30003 real-time) and send the robot's
/// state. A client need not read: what it leaves unread is dropped, the client stays.
class ScriptServer {
 public:
  /// Greets each new client, or nothing.
  ScriptServer(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
               Pendant & pendant, std::string greeting);
  ~ScriptServer();

  /// Sends a whole message to every client that keeps up.
  void broadcast(std::string_view message);
  Listener & listener() { return listener_; }
  const Listener & listener() const { return listener_; }
  bool has_clients() const { return !clients_.empty(); }

 private:
  struct Client {
    std::shared_ptr<Connection> connection;
    urscript::ScriptReader reader;
    std::uint64_t dropped = 0;
  };
  void accept(const std::shared_ptr<Connection> & connection);
  void receive(Client & client, std::string_view bytes);
  void report_dropped(Client & client);

  Pendant & pendant_;
  std::string greeting_;
  std::map<std::uint64_t, std::shared_ptr<Client>> clients_;
  Listener listener_;
};

}  // namespace ur_simulator::primary
