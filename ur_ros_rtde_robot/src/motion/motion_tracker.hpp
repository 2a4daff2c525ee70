#pragma once

#include <mutex>

#include "motion/arrival_detector.hpp"
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
    /// Incremented when the robot program ends or the connection is re-established, either of which ends all
    /// motions.
    std::uint32_t program = 0;
    std::uint64_t sequence = 0;
    double controller_time = 0.0;
    std::uint32_t link = 0;

    /// `async` was written by the previous program. The register keeps its value, possibly "running", until
    /// the current program writes it.
    bool async_is_stale = false;

    /// An asynchronous operation is running.
    bool operating() const { return program_running && !async_is_stale && async.running(); }
  };

  /// Ignores a sample that was added before, so that a thread that has just received the newest sample can
  /// add it without waiting for the receiving thread to do so.
  void add(const Sample & sample)
  {
    const std::lock_guard lock(mutex_);
    if (sample.sequence <= view_.sequence) {
      return;
    }
    const bool ended = (view_.program_running && !sample.program_running()) || sample.link != view_.link;
    const bool same_word = sample.async == view_.async;
    standstill_.add(sample);
    arrival_.add(sample, !ended && operation_ends(sample));
    view_ = {standstill_.at_rest() || arrival_.arrived(),
             sample.async,
             sample.program_running(),
             view_.program + (ended ? 1U : 0U),
             sample.sequence,
             sample.controller_time,
             sample.link,
             !sample.program_running() || ended || (view_.async_is_stale && same_word)};
  }
  View view() const
  {
    const std::lock_guard lock(mutex_);
    return view_;
  }

 private:
  /// The operation may have begun and ended since the previous sample. The first status of a program is no
  /// end of an operation.
  bool operation_ends(const Sample & sample) const
  {
    return !view_.async_is_stale && !sample.async.running() &&
           (view_.async.running() || sample.async.operation() != view_.async.operation());
  }

  mutable std::mutex mutex_;
  StandstillDetector standstill_;
  ArrivalDetector arrival_;
  View view_;
};

}  // namespace ur_ros_rtde
