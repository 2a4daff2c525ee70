#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "client_log/diagram_writer.hpp"
#include "client_log/rate_limit.hpp"

namespace ur_simulator {

class PeerLog;

/// What a robot and its clients do, as lines of a sequence diagram with the simulated time. Not thread-safe:
/// used on the controller's thread only.
class ClientLog {
 public:
  /// `time`: simulated time, s. With a name, several robots share a diagram.
  ClientLog(DiagramWriter & writer, const double & time, const std::string & robot_name = "");
  ~ClientLog();
  ClientLog(const ClientLog &) = delete;
  ClientLog & operator=(const ClientLog &) = delete;

  /// Adds a participant such as "dashboard client 1". Its number is the lowest that is not in use: a client
  /// that connects again continues its line.
  PeerLog add_peer(const std::string & kind);
  /// Notes an event of the robot itself.
  void add_event(std::string_view text);

  static constexpr std::size_t text_limit = 300;  ///< bytes; the rest is omitted
  /// Lines of one participant: at once, and then per second of simulated time. Further ones are counted.
  static constexpr double line_burst = 200.0;
  static constexpr double line_rate = 20.0;

 private:
  friend class PeerLog;
  enum class Arrow { from_peer, to_peer, closed_by_peer, closed_by_robot, note };

  struct Participant {
    ClientLog & log;
    std::string name;
    RateLimit limit{line_burst, line_rate};
    std::uint64_t left_out = 0;  ///< lines since the last one
  };

  std::shared_ptr<Participant> declare(std::string name);
  void add(Participant & participant, Arrow arrow, std::string_view text);
  void write_left_out(Participant & participant);
  void write(const Participant & participant, Arrow arrow, std::string_view text);

  DiagramWriter & writer_;
  const double & time_;
  const std::string suffix_;  ///< of the names of peers
  const std::shared_ptr<Participant> robot_;
  /// By kind. A participant that nothing else refers to is not in use.
  std::map<std::string, std::vector<std::shared_ptr<Participant>>> peers_;
};

/// The part of the client log that belongs to one peer of the robot: a client, or a host that a program
/// connects to. The texts are formatted only if there is a log.
class PeerLog {
 public:
  PeerLog() = default;  ///< no log

  /// What the peer sends.
  template <typename... Arguments>
  void from_peer(fmt::format_string<Arguments...> format, Arguments &&... arguments) const
  {
    add(ClientLog::Arrow::from_peer, format, std::forward<Arguments>(arguments)...);
  }
  /// What the robot sends to the peer.
  template <typename... Arguments>
  void to_peer(fmt::format_string<Arguments...> format, Arguments &&... arguments) const
  {
    add(ClientLog::Arrow::to_peer, format, std::forward<Arguments>(arguments)...);
  }
  /// What happens without data on the connection.
  template <typename... Arguments>
  void note(fmt::format_string<Arguments...> format, Arguments &&... arguments) const
  {
    add(ClientLog::Arrow::note, format, std::forward<Arguments>(arguments)...);
  }
  void closed_by_peer(std::string_view how) const { add(ClientLog::Arrow::closed_by_peer, "{}", how); }
  void closed_by_robot(std::string_view reason) const
  {
    add(ClientLog::Arrow::closed_by_robot, "closes the connection: {}", reason);
  }
  explicit operator bool() const { return participant_ != nullptr; }

 private:
  friend class ClientLog;
  explicit PeerLog(std::shared_ptr<ClientLog::Participant> participant) : participant_(std::move(participant))
  {
  }

  template <typename... Arguments>
  void add(ClientLog::Arrow arrow, fmt::format_string<Arguments...> format, Arguments &&... arguments) const
  {
    if (participant_) {
      participant_->log.add(*participant_, arrow, fmt::format(format, std::forward<Arguments>(arguments)...));
    }
  }

  std::shared_ptr<ClientLog::Participant> participant_;
};

}  // namespace ur_simulator
