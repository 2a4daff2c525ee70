#include "world_file/event_timeline.hpp"

#include <fmt/format.h>

#include <exception>

namespace ur_simulator {

void EventTimeline::cycle(control_port::ControlPortContext & context)
{
  const double now = static_cast<double>(++cycle_) * cycle_time_ + 0.5 * cycle_time_;
  for (; next_ < events_.size() && events_[next_].time <= now; ++next_) {
    const WorldFileCommand & event = events_[next_];
    try {
      event.action(context);
      context.log.info("world", event.origin);
    } catch (const std::exception & error) {
      context.log.error("world", fmt::format("{}: {}", event.origin, error.what()));
    }
  }
}

}  // namespace ur_simulator
