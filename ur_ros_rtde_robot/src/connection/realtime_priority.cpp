#include "ur_ros_rtde_robot/connection/realtime_priority.hpp"

#include <fmt/format.h>
#include <pthread.h>

#include <cerrno>
#include <cstring>

namespace ur_ros_rtde {
namespace {

/// Returns 0 or an errno value.
int set_fifo(int priority, int flags)
{
  sched_param wanted{};
  wanted.sched_priority = priority;
  // pthread_setschedparam() does not support flags. Thread id 0 is the calling thread.
  return sched_setscheduler(0, SCHED_FIFO | flags, &wanted) == 0 ? 0 : errno;
}

}  // namespace

Status set_realtime_priority(int priority)
{
  if (priority == 0) {
    return {};
  }
  if (const int error = set_fifo(priority, 0); error != 0) {
    return failure(
        ErrorCode::not_supported,
        fmt::format("realtime_priority {} is not permitted to this process ({}) and is ignored: "
                    "give its user rtprio {} or more in /etc/security/limits.conf, or its container "
                    "--ulimit rtprio={}",
                    priority, std::strerror(error), priority, priority));
  }
  return {};
}

RealtimePriority::RealtimePriority(int priority)
{
  if (priority == 0) {
    return;
  }
  policy_before_ = sched_getscheduler(0);
  changed_ =
      policy_before_ >= 0 && sched_getparam(0, &before_) == 0 && set_fifo(priority, SCHED_RESET_ON_FORK) == 0;
}

RealtimePriority::~RealtimePriority()
{
  if (changed_) {
    sched_setscheduler(0, policy_before_, &before_);
  }
}

}  // namespace ur_ros_rtde
