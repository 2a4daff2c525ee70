#pragma once

#include <array>
#include <chrono>
#include <cstdint>

#include "state/controller_state.hpp"

namespace ur_simulator {

/// Records the last cycles and the last commands with times of the host's clock. Clients on the same host
/// measure their latency with it. Does not allocate memory.
class CycleTrace {
 public:
  using Clock = std::chrono::system_clock;

  struct Cycle {
    std::uint64_t number = 0;
    std::int64_t published = 0;  ///< time before the cycle's RTDE packages were sent, ns since the epoch
    double speed = 0.0;          ///< largest target joint speed, rad/s
  };
  struct Command {
    std::uint64_t cycle = 0;
    std::int64_t arrived = 0;  ///< time at which the data package was read, ns since the epoch
    std::int32_t code = 0;     ///< input integer register 0: the command number of ur_rtde
  };

  /// Call before the packages of a cycle are sent: the first client may receive its package before the last
  /// package is sent.
  void record_cycle(const ControllerState & state)
  {
    cycles_[cycle_count_++ % cycles_.size()] = {state.cycle, now(),
                                                state.target.velocity.cwiseAbs().maxCoeff()};
  }
  /// Call after a data package has written input integer register 0. Code 0 (no command) is not recorded. A
  /// code equal to the previous one is recorded as a repeat: ur_rtde's servo and speed commands send the same
  /// code with each target. Repeats without arguments only feed the RTDE watchdog and are not recorded.
  void record_command(const ControllerState & state, bool with_arguments)
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
