#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace ur_simulator {

/// rtde_set_watchdog(): triggers an action if no RTDE client has written a variable for 1/frequency s while
/// the program that set the watchdog runs. The RTDE server calls `feed` for every variable of a data package;
/// the controller calls `expired` in every cycle.
class Watchdog {
 public:
  enum class Action : std::uint8_t { ignore, pause, stop };

  void set(const std::string & variable, double min_frequency, Action action, double now);
  /// A data package with this variable arrived at `now` (s, ControllerState::timestamp).
  void feed(const std::string & variable, double now);
  /// Removes all watchdogs, at the end of the program.
  void clear();
  /// The action of the first watchdog that expired. It is reported once; the next package re-arms the
  /// watchdog.
  std::optional<Action> expired(double now);

 private:
  struct Entry {
    std::string variable;
    double period;
    Action action;
    double last_fed;
    bool reported;
  };
  std::vector<Entry> entries_;
};

}  // namespace ur_simulator
