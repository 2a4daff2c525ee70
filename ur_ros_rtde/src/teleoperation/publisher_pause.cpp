#include "teleoperation/publisher_pause.hpp"

#include <chrono>

namespace ur_ros_rtde {

bool has_paused(const rcl_cxx::MessageInfo & before, const rcl_cxx::MessageInfo & next, double timeout)
{
  if (before.publisher != next.publisher) {
    return true;
  }
  const bool is_counted = before.number && next.number && *next.number > *before.number;
  const double sent = is_counted ? static_cast<double>(*next.number - *before.number) : 1.0;
  return std::chrono::duration<double>(next.published - before.published).count() / sent > timeout;
}

}  // namespace ur_ros_rtde
