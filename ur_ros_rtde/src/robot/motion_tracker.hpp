#pragma once

#include <mutex>

#include "ur_ros_rtde/motion.hpp"

namespace ur_ros_rtde {

/// What the samples tell about motion. Thread-safe.
class MotionTracker {
 public:
  struct View {
    bool at_rest = false;
    AsyncStatus async;
    std::uint64_t sequence = 0;
    double controller_time = 0.0;
  };

  void add(const Sample & sample)
  {
    const std::lock_guard lock(mutex_);
    standstill_.add(sample);
    view_ = {standstill_.at_rest(), sample.async, sample.sequence, sample.controller_time};
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
