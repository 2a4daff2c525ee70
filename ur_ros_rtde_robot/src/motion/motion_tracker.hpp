#pragma once

#include <mutex>

#include "ur_ros_rtde_robot/motion/motion.hpp"

namespace ur_ros_rtde {

/// Tracks the motion state from the samples. Thread-safe.
class MotionTracker {
 public:
  struct View {
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

  void add(const Sample & sample)
  {
    const std::lock_guard lock(mutex_);
    standstill_.add(sample);
    const bool ended = (view_.program_running && !sample.program_running()) || sample.link != view_.link;
    const bool same_word = sample.async == view_.async;
    view_ = {standstill_.at_rest(),
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
  mutable std::mutex mutex_;
  StandstillDetector standstill_;
  View view_;
};

}  // namespace ur_ros_rtde
