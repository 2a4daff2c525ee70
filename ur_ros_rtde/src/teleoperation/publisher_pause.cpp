#include "teleoperation/publisher_pause.hpp"

#include <chrono>

namespace ur_ros_rtde {

namespace {
/// s, by the clock of their publisher.
double time_between(const rcl_cxx::MessageInfo & before, const rcl_cxx::MessageInfo & next)
{
  return std::chrono::duration<double>(next.published - before.published).count();
}

/// s, between messages of one publisher, as it published them. `next` may follow after others that were lost.
double mean_interval(const rcl_cxx::MessageInfo & before, const rcl_cxx::MessageInfo & next)
{
  const bool is_counted = before.number && next.number && *next.number > *before.number;
  const double sent = is_counted ? static_cast<double>(*next.number - *before.number) : 1.0;
  return time_between(before, next) / sent;
}
}  // namespace

bool has_paused(const rcl_cxx::MessageInfo & before, const rcl_cxx::MessageInfo & next, double timeout)
{
  return before.publisher != next.publisher || mean_interval(before, next) > timeout;
}

std::optional<double> age_of_publisher(const rcl_cxx::MessageInfo & before, const rcl_cxx::MessageInfo & next,
                                       double shortest_time)
{
  if (before.publisher != next.publisher || !before.number || !next.number ||
      *next.number <= *before.number || time_between(before, next) < shortest_time) {
    return std::nullopt;
  }
  return static_cast<double>(*next.number - 1) * mean_interval(before, next);
}

}  // namespace ur_ros_rtde
