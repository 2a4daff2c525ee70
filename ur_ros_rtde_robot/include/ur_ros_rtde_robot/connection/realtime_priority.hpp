#pragma once

#include <sched.h>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// For ur_rtde's constructors: they must not change the priority of our thread, as they would, to SCHED_FIFO
/// 90, on a real-time kernel.
inline constexpr int keep_priority = -1;

/// The calling thread, and the threads that it starts from now on, under SCHED_FIFO (sched(7)) with
/// `priority`, 1 to 99; 0 changes nothing. Refused when this process may not: the error tells what to do.
Status set_realtime_priority(int priority);

/// The same for the calling thread alone, while this lives; it goes on as it was when it may not.
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
