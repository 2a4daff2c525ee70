#include <algorithm>

#include "script_api/robot_library.hpp"

namespace ur_simulator {

void Watchdog::set(const std::string & variable, double minimum_frequency, Action action, double now)
{
  std::erase_if(entries_, [&](const Entry & entry) { return entry.variable == variable; });
  if (minimum_frequency > 0.0) {
    entries_.push_back({variable, 1.0 / minimum_frequency, action, now, false});
  }
}

void Watchdog::fed(const std::string & variable, double now)
{
  for (Entry & entry : entries_) {
    if (entry.variable == variable) {
      entry.last = now;
      entry.reported = false;
    }
  }
}

void Watchdog::clear()
{
  entries_.clear();
}

std::optional<Watchdog::Action> Watchdog::expired(double now)
{
  for (Entry & entry : entries_) {
    if (!entry.reported && entry.action != Action::ignore && now - entry.last > entry.period) {
      entry.reported = true;
      return entry.action;
    }
  }
  return std::nullopt;
}

}  // namespace ur_simulator
