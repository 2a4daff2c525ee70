#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace ur_simulator {

enum class LogLevel { info, warning, error };

/// "info", "warning" or "error".
std::string_view name(LogLevel level);

/// What the primary interface makes of an entry beyond its text.
enum class LogKind { text, program_started, program_ended, popup, safety };

struct LogEntry {
  std::uint64_t number = 0;  ///< counts from 1, never reused
  double timestamp = 0.0;    ///< s on the controller's clock
  LogLevel level = LogLevel::info;
  std::string source;  ///< room that says it: "rtde", "program", …
  std::string text;
  std::int32_t line = -1;    ///< of the program's text that it is about, 1-based; -1: none
  std::int32_t column = -1;  ///< 1-based; -1: none
  LogKind kind = LogKind::text;
  std::string title;      ///< of a popup; a program's name
  bool blocking = false;  ///< popup
};

/// What a robot would show on its log tab: the most recent entries, in order. Belongs to the controller's
/// thread.
class EventLog {
 public:
  using Listener = std::function<void(const LogEntry &)>;

  /// The clock that stamps entries, s.
  void set_time(double timestamp) { timestamp_ = timestamp; }
  /// Called for every further entry.
  void add_listener(Listener listener) { listeners_.push_back(std::move(listener)); }
  void add(LogLevel level, std::string_view source, std::string text, std::int32_t line = -1,
           std::int32_t column = -1);
  /// The log numbers and dates the entry.
  void add(LogEntry entry);
  void info(std::string_view source, std::string text) { add(LogLevel::info, source, std::move(text)); }
  void warning(std::string_view source, std::string text) { add(LogLevel::warning, source, std::move(text)); }
  void error(std::string_view source, std::string text) { add(LogLevel::error, source, std::move(text)); }
  const std::deque<LogEntry> & entries() const { return entries_; }

 private:
  static constexpr std::size_t kept = 1000;

  double timestamp_ = 0.0;
  std::uint64_t count_ = 0;
  std::deque<LogEntry> entries_;
  std::vector<Listener> listeners_;
};

}  // namespace ur_simulator
