#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "state/controller_state.hpp"

namespace ur_simulator {

/// The newest entries of a trace. Entry has the member `cycle`.
template <typename Entry>
class TraceBuffer {
 public:
  explicit TraceBuffer(std::size_t capacity) : entries_(capacity) {}

  void add(const Entry & entry)
  {
    Entry & oldest = entries_[count_++ % entries_.size()];
    if (count_ > entries_.size()) {
      last_overwritten_cycle_ = oldest.cycle;
    }
    oldest = entry;
  }
  /// Oldest first.
  template <typename Visit>
  void for_each(Visit && visit) const
  {
    const std::uint64_t first = count_ > entries_.size() ? count_ - entries_.size() : 0;
    for (std::uint64_t i = first; i < count_; ++i) {
      visit(entries_[i % entries_.size()]);
    }
  }
  /// Entries up to this cycle are incomplete; 0 if none was overwritten.
  std::uint64_t last_overwritten_cycle() const { return last_overwritten_cycle_; }
  void clear()
  {
    count_ = 0;
    last_overwritten_cycle_ = 0;
  }

 private:
  std::vector<Entry> entries_;
  std::uint64_t count_ = 0;
  std::uint64_t last_overwritten_cycle_ = 0;
};

/// Records the last cycles and the last commands with times of the host's clock. Clients on the same host
/// measure their latency with it. Allocates memory only on construction.
class CycleTrace {
 public:
  using Clock = std::chrono::system_clock;

  static constexpr std::size_t cycle_capacity = 16384;  ///< 32 s at 500 Hz
  static constexpr std::size_t command_capacity = 256;
  static constexpr std::size_t repeat_capacity = 16384;

  struct Cycle {
    std::uint64_t cycle = 0;
    std::int64_t published = 0;  ///< time before the cycle's RTDE packages were sent, ns since the epoch
    double joint_speed = 0.0;    ///< largest target joint speed, rad/s
    double tcp_speed = 0.0;      ///< target speed of the TCP, m/s
  };
  struct Command {
    std::uint64_t cycle = 0;
    std::int64_t arrived = 0;  ///< time at which the data package was read, ns since the epoch
    std::int32_t code = 0;     ///< input integer register 0: the command number of ur_rtde
  };
  struct Repeat : Command {
    bool is_held = false;  ///< the target is that of the package before
  };

  /// Call before the packages of a cycle are sent: the first client may receive its package before the last
  /// package is sent.
  void record_cycle(const ControllerState & state)
  {
    cycles_.add({state.cycle, now(), state.target.velocity.cwiseAbs().maxCoeff(),
                 state.target_tcp_speed.head<3>().norm()});
  }
  /// Call after a data package has written input integer register 0. Code 0 (no command) is not recorded. A
  /// code equal to the previous one is recorded as a repeat: ur_rtde's servo and speed commands send the same
  /// code with each target. Repeats without arguments only feed the RTDE watchdog and are not recorded.
  void record_command(const ControllerState & state, bool with_arguments)
  {
    const std::int32_t code = state.inputs.integers[0];
    Target target{};
    std::copy_n(state.inputs.floats.begin(), target.size(), target.begin());
    if (code != 0 && code == last_code_ && with_arguments) {
      repeats_.add({{state.cycle, now(), code}, target == last_target_});
    }
    if (code != 0 && code != last_code_) {
      commands_.add({state.cycle, now(), code});
    }
    last_code_ = code;
    last_target_ = target;
  }

  /// Call when the count of cycles restarts.
  void clear()
  {
    cycles_.clear();
    commands_.clear();
    repeats_.clear();
    last_code_ = 0;
    last_target_ = {};
  }

  const TraceBuffer<Cycle> & cycles() const { return cycles_; }
  const TraceBuffer<Command> & commands() const { return commands_; }
  const TraceBuffer<Repeat> & repeats() const { return repeats_; }
  /// The data of all later cycles is complete.
  std::uint64_t last_incomplete_cycle() const
  {
    return std::max({cycles_.last_overwritten_cycle(), commands_.last_overwritten_cycle(),
                     repeats_.last_overwritten_cycle()});
  }

 private:
  /// Input double registers 0 to 5: the position, pose or speed of ur_rtde's commands.
  using Target = std::array<double, 6>;

  static std::int64_t now()
  {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch()).count();
  }

  TraceBuffer<Cycle> cycles_{cycle_capacity};
  TraceBuffer<Command> commands_{command_capacity};
  TraceBuffer<Repeat> repeats_{repeat_capacity};
  std::int32_t last_code_ = 0;
  Target last_target_{};
};

}  // namespace ur_simulator
