#include "script_api/watchdog.hpp"

#include <algorithm>

namespace ur_simulator {

void Watchdog::set(const std::string & variable, double min_frequency, Action action, double now)
{
  std::erase_if(entries_, [&](const Entry & entry) { return entry.variable == variable; });
  if (min_frequency > 0.0) {
    entries_.push_back({variable, 1.0 / min_frequency, action, now, false});
  }
}

void Watchdog::feed(const std::string & variable, double now)
{
  for (Entry & entry : entries_) {
    if (entry.variable == variable) {
      entry.last_fed = now;
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
    if (!entry.reported && entry.action != Action::ignore && now - entry.last_fed > entry.period) {
      entry.reported = true;
      return entry.action;
    }
  }
  return std::nullopt;
}

}  // namespace ur_simulator
