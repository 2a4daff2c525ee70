#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "common/error_code.hpp"

namespace ur_simulator {

enum class LogLevel { info, warning, error };

/// "info", "warning" or "error".
std::string_view to_string(LogLevel level);

/// Selects the message type in which the primary interface reports an entry.
enum class LogKind { text, program_started, program_ended, popup, value_request, error_code, safety_mode };

struct LogEntry {
  std::uint64_t number = 0;  ///< consecutive, starts at 1
  double timestamp = 0.0;    ///< simulated time, s
  LogLevel level = LogLevel::info;
  std::string source;  ///< reporting module: "rtde", "program", …
  std::string text;
  std::int32_t line = -1;    ///< line of the program, 1-based; -1: none
  std::int32_t column = -1;  ///< column of the program, 1-based; -1: none
  LogKind kind = LogKind::text;
  std::string title;                ///< title of the popup, or name of the program
  std::uint8_t requested_type = 0;  ///< value requests only: as in the request value message
  bool blocking = false;            ///< popups only: the program waits until the popup is closed
  ErrorCode code;                   ///< error codes only
  std::uint8_t safety_mode = 0;     ///< safety modes only: as in the RTDE output
  std::string exception;            ///< text of the runtime exception message; empty: `text`
};

/// One line: timestamp, level, source and text, in columns.
std::string to_string(const LogEntry & entry);

/// The entries of the log tab of PolyScope, oldest first. Keeps the most recent 1000 entries. Not
/// thread-safe: used on the controller's thread only.
class EventLog {
 public:
  using Listener = std::function<void(const LogEntry &)>;

  /// Sets the timestamp of the entries that follow, s.
  void set_time(double timestamp) { timestamp_ = timestamp; }
  /// `listener` is called for every entry added from now on.
  void add_listener(Listener listener) { listeners_.push_back(std::move(listener)); }
  void add(LogLevel level, std::string_view source, std::string text, std::int32_t line = -1,
           std::int32_t column = -1);
  /// Adds the entry with the next number and the current timestamp.
  void add(LogEntry entry);
  void info(std::string_view source, std::string text) { add(LogLevel::info, source, std::move(text)); }
  void warning(std::string_view source, std::string text) { add(LogLevel::warning, source, std::move(text)); }
  void error(std::string_view source, std::string text) { add(LogLevel::error, source, std::move(text)); }
  /// Adds an error with an error code of the controller.
  void error(std::string_view source, const ErrorCode & code, std::string text);
  const std::deque<LogEntry> & entries() const { return entries_; }

 private:
  static constexpr std::size_t max_entries = 1000;

  double timestamp_ = 0.0;
  std::uint64_t count_ = 0;
  std::deque<LogEntry> entries_;
  std::vector<Listener> listeners_;
};

}  // namespace ur_simulator
