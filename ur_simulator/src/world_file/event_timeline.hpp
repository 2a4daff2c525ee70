#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "control_port/control_port_context.hpp"
#include "world_file/world_file.hpp"

namespace ur_simulator {

/// Executes the events of a world file at their simulated time. The time continues when the controller
/// reboots.
class EventTimeline {
 public:
  /// The events are sorted by time.
  EventTimeline(std::vector<WorldFileCommand> events, double cycle_time)
      : events_(std::move(events)), cycle_time_(cycle_time)
  {
  }

  /// Call at the beginning of each cycle. Executes the events that are due. The log reports each of them, and
  /// as an error those that are rejected.
  void cycle(control_port::ControlPortContext & context);

 private:
  std::vector<WorldFileCommand> events_;
  double cycle_time_;
  std::uint64_t cycle_ = 0;
  std::size_t next_ = 0;
};

}  // namespace ur_simulator
