#pragma once

#include <string>
#include <string_view>

#include "ur_ros_rtde/check.hpp"

namespace ur_ros_rtde {

/// The upper limits of the fields `speed` and `acceleration` of a goal or of a waypoint.
struct SpeedLimits {
  double speed;
  std::string_view speed_unit;
  double acceleration;
  std::string_view acceleration_unit;
};
constexpr SpeedLimits joint_speed_limits{3.14, "rad/s", 40.0, "rad/s^2"};
constexpr SpeedLimits linear_speed_limits{3.0, "m/s", 150.0, "m/s^2"};

/// Limits of decelerations in goals.
constexpr double max_joint_deceleration = 40.0;    // rad/s^2
constexpr double max_linear_deceleration = 150.0;  // m/s^2
constexpr double max_servo_deceleration = 40.0;    // rad/s^2 or m/s^2
constexpr double min_deceleration = 0.1;           // rad/s^2 or m/s^2

/// Checks the fields `speed` and `acceleration` of a goal, or of a waypoint of a goal with `prefix`
/// "waypoints[3].".
template <typename Motion>
Check & check_speed(Check & check, const Motion & motion, const SpeedLimits & limits,
                    const std::string & prefix = {})
{
  return check.above_zero(prefix + "speed", motion.speed, limits.speed, limits.speed_unit)
      .above_zero(prefix + "acceleration", motion.acceleration, limits.acceleration,
                  limits.acceleration_unit);
}

}  // namespace ur_ros_rtde
