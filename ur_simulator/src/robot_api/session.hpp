#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "net/connection.hpp"
#include "polyscope/pendant.hpp"
#include "robot_api/http_request.hpp"
#include "robot_api/reply.hpp"

namespace ur_simulator::robot_api {

struct HttpLimits {
  std::size_t header_size = 8 * 1024;       ///< bytes
  std::size_t body_size = 4 * 1024 * 1024;  ///< bytes
  /// Time in which a client has to send a complete request, and for which an idle connection stays open. By
  /// the host's clock.
  std::chrono::milliseconds request_time{60000};
};

/// The HTTP connection of a client. It executes one request at a time, at most one per control cycle, and
/// sends the reply in a later cycle. Further requests of the client wait.
class Session {
 public:
  Session(std::shared_ptr<Connection> connection, Pendant & pendant, const HttpLimits & limits);
  ~Session();
  Session(const Session &) = delete;
  Session & operator=(const Session &) = delete;

  void receive(std::string_view bytes);
  /// Sends what has become available and checks the limits. Call once per control cycle.
  void cycle();

 private:
  using Clock = std::chrono::steady_clock;
  struct Parser;

  /// Returns whether a request is complete.
  bool parse();
  void execute();
  void send(const Reply & reply);
  /// Replies to a request that cannot be read, and closes the connection.
  void reject(unsigned status, std::string_view message);
  void send_outgoing();
  void extend_deadline() { deadline_ = Clock::now() + limits_.request_time; }
  bool replying() const { return pending_ != nullptr || !outgoing_.empty(); }

  std::shared_ptr<Connection> connection_;
  Pendant & pendant_;
  HttpLimits limits_;
  std::unique_ptr<Parser> parser_;
  std::string received_;
  std::string outgoing_;
  PendingReply pending_;
  bool head_ = false;       ///< the request wants the headers of the reply only
  bool keep_alive_ = true;  ///< the connection stays open after the reply
  bool rejected_ = false;   ///< received data is discarded until the client or the deadline closes
  Clock::time_point deadline_;
};

}  // namespace ur_simulator::robot_api
