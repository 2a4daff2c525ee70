#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>

#include "motion/arrival_detector.hpp"
#include "motion/motion_blocker.hpp"
#include "ur_ros_rtde_robot/connection/link.hpp"
#include "ur_ros_rtde_robot/motion/motion.hpp"

namespace ur_ros_rtde {

/// Tracks the motion state from the samples. Thread-safe.
class MotionTracker {
 public:
  struct View {
    /// By StandstillDetector or ArrivalDetector.
    bool at_rest = false;
    AsyncStatus async;
    bool program_running = false;
    /// Incremented when the robot program ends, when it is found paused without having been seen to run, and
    /// when the connection is re-established, each of which ends all motions.
    std::uint32_t program = 0;
    /// Incremented when the robot stops (motion_blocker), with or without a program.
    std::uint32_t robot_stops = 0;
    std::uint64_t sequence = 0;
    double controller_time = 0.0;
    std::uint32_t link = 0;

    /// s of this host's time: the longest time without a package in the last `gap_memory`.
    double gap = 0.0;
    double gap_time = 0.0;  ///< controller time of its end

    /// `async` was written by the previous program. The register keeps its value, possibly "running", until
    /// the current program writes it.
    bool async_is_stale = false;

    /// An asynchronous operation is running.
    bool operating() const { return program_running && !async_is_stale && async.running(); }
  };

  static constexpr double gap_memory = 1.0;  // s

  /// Returns why a program that ends now has ended, if this is known. Must not wait.
  using Cause = std::function<std::optional<Error>()>;

  explicit MotionTracker(Cause cause = [] { return std::nullopt; }) : cause_(std::move(cause)) {}

  /// Ignores a sample that was added before, so that a thread that has just received the newest sample can
  /// add it without waiting for the receiving thread to do so.
  void add(const Sample & sample)
  {
    const std::lock_guard lock(mutex_);
    if (sample.sequence <= view_.sequence) {
      return;
    }
    const bool found_paused = is_paused(sample) && !view_.program_running && !was_paused_;
    const bool ended =
        (view_.program_running && !sample.is_program_running()) || found_paused || sample.link != view_.link;
    const auto blocker = motion_blocker(sample);
    const bool robot_stops = blocker && !was_blocked_;
    if (robot_stops) {
      stop_cause_ = *blocker;
    }
    const bool same_word = sample.async == view_.async;
    standstill_.add(sample);
    arrival_.add(sample, !ended && operation_ends(sample));
    if (ended) {
      end_cause_ = sample.link != view_.link ? Error{ErrorCode::link_lost, connection_replaced}
                   : blocker                 ? *blocker
                                             : cause_().value_or(Error{});
    }
    const double gap = view_.sequence == 0 ? 0.0 : seconds_between(received_, sample.received);
    const bool keeps_gap = gap <= view_.gap && sample.controller_time - view_.gap_time < gap_memory;
    received_ = sample.received;
    was_paused_ = is_paused(sample);
    was_blocked_ = blocker.has_value();
    view_ = {.at_rest = standstill_.at_rest() || arrival_.arrived(),
             .async = sample.async,
             .program_running = sample.is_program_running(),
             .program = view_.program + (ended ? 1U : 0U),
             .robot_stops = view_.robot_stops + (robot_stops ? 1U : 0U),
             .sequence = sample.sequence,
             .controller_time = sample.controller_time,
             .link = sample.link,
             .gap = keeps_gap ? view_.gap : gap,
             .gap_time = keeps_gap ? view_.gap_time : sample.controller_time,
             .async_is_stale = !sample.is_program_running() || ended || (view_.async_is_stale && same_word)};
  }
  View view() const
  {
    const std::lock_guard lock(mutex_);
    return view_;
  }
  /// What ended the newest program: a lost connection, or the state of the robot (ErrorCode::none: neither).
  Error end_cause() const
  {
    const std::lock_guard lock(mutex_);
    return end_cause_;
  }
  /// The newest stop of the robot.
  Error stop_cause() const
  {
    const std::lock_guard lock(mutex_);
    return stop_cause_;
  }

 private:
  /// Until it has gone on.
  static bool is_paused(const Sample & sample)
  {
    return sample.runtime_state == RuntimeState::pausing || sample.runtime_state == RuntimeState::paused ||
           sample.runtime_state == RuntimeState::resuming;
  }
  static double seconds_between(std::chrono::steady_clock::time_point a,
                                std::chrono::steady_clock::time_point b)
  {
    return std::chrono::duration<double>(b - a).count();
  }

  /// The operation may have begun and ended since the previous sample. The first status of a program is no
  /// end of an operation.
  bool operation_ends(const Sample & sample) const
  {
    return !view_.async_is_stale && !sample.async.running() &&
           (view_.async.running() || sample.async.operation() != view_.async.operation());
  }

  const Cause cause_;
  mutable std::mutex mutex_;
  StandstillDetector standstill_;
  ArrivalDetector arrival_;
  View view_;
  bool was_paused_ = false;
  bool was_blocked_ = false;
  std::chrono::steady_clock::time_point received_{};  ///< of the newest sample
  Error end_cause_;
  Error stop_cause_;
};

}  // namespace ur_ros_rtde
