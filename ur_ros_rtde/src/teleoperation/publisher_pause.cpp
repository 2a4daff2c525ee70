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

bool has_begun_since(const rcl_cxx::MessageInfo & before, const rcl_cxx::MessageInfo & next,
                     std::chrono::system_clock::time_point time)
{
  if (before.publisher != next.publisher || !before.number || !next.number ||
      *next.number <= *before.number) {
    return false;
  }
  const std::chrono::duration<double> interval = next.published - before.published;
  const auto period = interval / static_cast<double>(*next.number - *before.number);
  return next.published - static_cast<double>(*next.number - 1) * period > time;
}

}  // namespace ur_ros_rtde
