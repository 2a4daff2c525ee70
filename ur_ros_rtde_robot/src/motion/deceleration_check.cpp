#include "motion/deceleration_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {

DecelerationCheck::Speeds DecelerationCheck::speeds(const Sample & sample)
{
  Speeds result;
  for (const double velocity : sample.target_qd) {
    constexpr double unknown = std::numeric_limits<double>::infinity();
    result.joint = std::max(result.joint, std::isnan(velocity) ? unknown : std::abs(velocity));
  }
  result.tcp = length(position(sample.target_tcp_speed));
  return result;
}

bool DecelerationCheck::add(const Sample & sample)
{
  constexpr double change = 1e-7;
  const Speeds now = speeds(sample);
  if (begun_ && sample.controller_time - begin_ < window) {
    return true;
  }
  const bool slower =
      !begun_ || now.joint == 0.0 || now.joint < at_begin_.joint - change || now.tcp < at_begin_.tcp - change;
  begun_ = true;
  begin_ = sample.controller_time;
  at_begin_ = now;
  return slower;
}

}  // namespace ur_ros_rtde
