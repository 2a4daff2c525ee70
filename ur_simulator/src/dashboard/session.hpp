#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "net/connection.hpp"
#include "polyscope/pendant.hpp"
#include "polyscope/pending_reply.hpp"

namespace ur_simulator::dashboard {

/// The connection of a client of the dashboard server: each line is a command, answered with one line.
class Session {
 public:
  Session(std::shared_ptr<Connection> connection, Pendant & pendant);

  void receive(std::string_view bytes);
  /// Sends a pending reply that has become available. Call once per control cycle.
  void cycle();

 private:
  void handle_line(std::string_view line);
  bool is_rejected(bool requires_remote_control) const;
  void send(std::string_view reply);
  void send_pending_reply();

  std::shared_ptr<Connection> connection_;
  Pendant & pendant_;
  std::string received_;
  /// Remote control when the client connected: an e-Series controller applies it until the client reconnects.
  bool remote_control_at_connect_;
  /// Reply of the current command. Later commands of the client wait for it.
  PendingReply pending_reply_;
};

}  // namespace ur_simulator::dashboard
