#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "net/listener.hpp"
#include "polyscope/pendant.hpp"

namespace ur_simulator::dashboard {

/// The dashboard server: each line is a command, answered with one line (UR, "Dashboard Server e-Series" and
/// "Dashboard Server CB-Series").
class Server {
 public:
  Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port, Pendant & pendant);
  ~Server();
  /// Serves a connection, as each that the listener accepts.
  void accept(const std::shared_ptr<Connection> & connection);
  Listener & listener() { return listener_; }
  const Listener & listener() const { return listener_; }
  /// Sends the pending replies that have become available. Call once per control cycle.
  void cycle();

 private:
  struct Client {
    std::shared_ptr<Connection> connection;
    std::string received;
    /// Remote control when the client connected: an e-Series controller applies it until the client
    /// reconnects.
    bool remote_control_at_connect;
    /// Reply of the current command. Later commands of the client wait for it.
    PendingReply pending_reply = nullptr;
  };
  void receive(Client & client, std::string_view bytes);
  void handle_line(Client & client, std::string_view line);
  bool is_refused(const Client & client, bool requires_remote_control) const;
  void send_pending_reply(Client & client);

  Pendant & pendant_;
  std::map<std::uint64_t, Client> clients_;
  Listener listener_;
};

}  // namespace ur_simulator::dashboard
