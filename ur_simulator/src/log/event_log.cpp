#include "log/event_log.hpp"

#include <utility>

namespace ur_simulator {

std::string_view name(LogLevel level)
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

void EventLog::add(LogLevel level, std::string_view source, std::string text)
{
  entries_.push_back({++count_, timestamp_, level, std::string(source), std::move(text)});
  if (entries_.size() > kept) {
    entries_.pop_front();
  }
  for (const Listener & listener : listeners_) {
    listener(entries_.back());
  }
}

}  // namespace ur_simulator
