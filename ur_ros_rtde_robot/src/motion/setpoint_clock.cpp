#include "ur_ros_rtde_robot/motion/setpoint_clock.hpp"

#include <algorithm>

namespace ur_ros_rtde {
namespace {

double pace(double cycles_behind)
{
  constexpr double reaction = 0.05;  // share of the distance that the target catches up in a cycle
  constexpr double slowest = 0.5;
  return cycles_behind > 0.0 ? std::max(slowest, 1.0 - reaction * cycles_behind) : 1.0;
}

}  // namespace

double SetpointClock::advance(const Sample & now, double elapsed)
{
  pace_ = pace(-1.0 - now.servo_ahead());
  const double passed = pace_ * elapsed;
  time_ += std::clamp(passed / cycle_, 0.0, bridged_cycles);
  if (time_ > longest_time) {
    time_ = first_time;
  }
  return passed;
}

bool SetpointClock::is_at_end(double overtime) const
{
  constexpr double longest_catch_up = 1.0;  // s; beyond, the register belongs to someone else
  return overtime >= 0.0 && (pace_ == 1.0 || overtime > longest_catch_up);
}

}  // namespace ur_ros_rtde
