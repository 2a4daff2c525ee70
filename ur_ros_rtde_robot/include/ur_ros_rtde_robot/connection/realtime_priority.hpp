#pragma once

#include <sched.h>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Argument for ur_rtde's constructors: without it they set the priority of the calling thread to SCHED_FIFO
/// 90 on a real-time kernel.
inline constexpr int keep_priority = -1;

/// Schedules the calling thread, and the threads that it starts later, under SCHED_FIFO (sched(7)) with
/// `priority`, 1 to 99; 0 changes nothing. not_supported, with the remedy, if this process lacks permission.
Status set_realtime_priority(int priority);

/// Raises the priority of the calling thread alone, for the lifetime of this object. Changes nothing if this
/// process lacks permission.
class RealtimePriority {
 public:
  explicit RealtimePriority(int priority);
  ~RealtimePriority();
  RealtimePriority(const RealtimePriority &) = delete;
  RealtimePriority & operator=(const RealtimePriority &) = delete;

 private:
  bool changed_ = false;
  int policy_before_ = 0;
  sched_param before_{};
};

}  // namespace ur_ros_rtde
