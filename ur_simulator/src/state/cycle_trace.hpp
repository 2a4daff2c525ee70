#pragma once

#include <array>
#include <chrono>
#include <cstdint>

#include "state/controller_state.hpp"

namespace ur_simulator {

/// What happened when, by the host's clock: the last cycles and the last commands, for measuring what lies
/// between the controller and a client on the same host. No allocation.
class CycleTrace {
 public:
  using Clock = std::chrono::system_clock;

  struct Cycle {
    std::uint64_t number = 0;
    std::int64_t published = 0;  ///< ns since the epoch, when sending the cycle's RTDE packages began
    double speed = 0.0;          ///< of the fastest joint's target, rad/s
  };
  struct Command {
    std::uint64_t cycle = 0;
    std::int64_t arrived = 0;  ///< ns since the epoch, when the package was read
    std::int32_t code = 0;     ///< input integer register 0: ur_rtde's command number
  };

  /// Before the packages of a cycle are sent: a client may have its own before the last is out.
  void cycle_publishing(const ControllerState & state)
  {
    cycles_[cycle_count_++ % cycles_.size()] = {state.cycle, now(),
                                                state.target.velocity.cwiseAbs().maxCoeff()};
  }
  /// Input integer register 0 was written; 0 (no command) is not kept, repeats are kept apart: they are what
  /// a stream of targets is made of. A repeat without arguments is none of them: it feeds the watchdog.
  void command_arrived(const ControllerState & state, bool with_arguments)
  {
    const std::int32_t code = state.inputs.integers[0];
    if (code != 0 && code == last_code_ && with_arguments) {
      repeats_[repeat_count_++ % repeats_.size()] = {state.cycle, now(), code};
    }
    if (code != 0 && code != last_code_) {
      commands_[command_count_++ % commands_.size()] = {state.cycle, now(), code};
    }
    last_code_ = code;
  }

  template <typename Visit>
  void for_each_cycle(Visit && visit) const
  {
    for_each(cycles_, cycle_count_, visit);
  }
  template <typename Visit>
  void for_each_command(Visit && visit) const
  {
    for_each(commands_, command_count_, visit);
  }
  template <typename Visit>
  void for_each_repeat(Visit && visit) const
  {
    for_each(repeats_, repeat_count_, visit);
  }

 private:
  static std::int64_t now()
  {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch()).count();
  }
  /// Oldest first.
  template <typename Ring, typename Visit>
  static void for_each(const Ring & ring, std::uint64_t count, Visit && visit)
  {
    const std::uint64_t first = count > ring.size() ? count - ring.size() : 0;
    for (std::uint64_t i = first; i < count; ++i) {
      visit(ring[i % ring.size()]);
    }
  }

  std::array<Cycle, 4096> cycles_;
  std::array<Command, 256> commands_;
  std::array<Command, 1024> repeats_;
  std::uint64_t cycle_count_ = 0;
  std::uint64_t command_count_ = 0;
  std::uint64_t repeat_count_ = 0;
  std::int32_t last_code_ = 0;
};

}  // namespace ur_simulator
