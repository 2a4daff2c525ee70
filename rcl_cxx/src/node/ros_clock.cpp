#include "node/ros_clock.hpp"

#include "rcl_support/rcl_error.hpp"

namespace rcl_cxx::detail {
RosClock::RosClock()
{
  rcl_allocator_t allocator = rcl_get_default_allocator();
  check_rcl(rcl_clock_init(RCL_ROS_TIME, &clock_, &allocator), "clock", "cannot be created");
}

RosClock::~RosClock()
{
  ignore_rcl(rcl_clock_fini(&clock_));
}

std::int64_t RosClock::now_ns() const
{
  const std::lock_guard lock(mutex_);
  rcl_time_point_value_t now = 0;
  check_rcl(rcl_clock_get_now(&clock_, &now), "clock", "has no time");
  return now;
}

void RosClock::override_with(std::optional<std::int64_t> now_ns)
{
  const std::lock_guard lock(mutex_);
  if (!now_ns) {
    check_rcl(rcl_disable_ros_time_override(&clock_), "clock", "cannot return to system time");
    return;
  }
  check_rcl(rcl_set_ros_time_override(&clock_, *now_ns), "clock", "cannot be set");
  check_rcl(rcl_enable_ros_time_override(&clock_), "clock", "cannot be overridden");
}

}  // namespace rcl_cxx::detail
