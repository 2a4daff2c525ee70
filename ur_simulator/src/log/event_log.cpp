#include "log/event_log.hpp"

#include <fmt/format.h>

#include <utility>

namespace ur_simulator {

std::string_view to_string(LogLevel level)
{
  switch (level) {
    case LogLevel::info:
      return "info";
    case LogLevel::warning:
      return "warning";
    case LogLevel::error:
      return "error";
  }
  return "unknown";
}

std::string to_string(const LogEntry & entry)
{
  return fmt::format("{:10.3f} {:7} {:10} {}", entry.timestamp, to_string(entry.level), entry.source,
                     entry.text);
}

void EventLog::add(LogLevel level, std::string_view source, std::string text, std::int32_t line,
                   std::int32_t column)
{
  LogEntry entry;
  entry.level = level;
  entry.source = source;
  entry.text = std::move(text);
  entry.line = line;
  entry.column = column;
  add(std::move(entry));
}

void EventLog::error(std::string_view source, const ErrorCode & code, std::string text)
{
  LogEntry entry;
  entry.level = LogLevel::error;
  entry.source = source;
  entry.text = std::move(text);
  entry.kind = LogKind::error_code;
  entry.code = code;
  add(std::move(entry));
}

void EventLog::add(LogEntry entry)
{
  entry.number = ++count_;
  entry.timestamp = timestamp_;
  entries_.push_back(std::move(entry));
  if (entries_.size() > max_entries) {
    entries_.pop_front();
  }
  for (const Listener & listener : listeners_) {
    listener(entries_.back());
  }
}

}  // namespace ur_simulator
