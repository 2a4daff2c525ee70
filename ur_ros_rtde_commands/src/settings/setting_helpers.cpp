#include "settings/setting_helpers.hpp"

#include <fmt/format.h>

namespace ur_ros_rtde {
Outcome send_failure()
{
  return Outcome::failure(ErrorCode::link_lost, "the value could not be sent to the robot: try again");
}

Outcome set_analog_output(Run & run, unsigned pin, double value, double tolerance, const char * unit,
                          const std::function<bool(ur_rtde::RTDEIOInterface &)> & set)
{
  if (!set(*run.io().hold())) {
    return send_failure();
  }
  const auto is_set = [&] { return std::abs(run.state().analog_outputs[pin] - value) <= tolerance; };
  Outcome outcome = run.expect(is_set, setting_timeout, "");
  if (outcome.code() != ErrorCode::rejected_by_robot) {
    return outcome;
  }
  return Outcome::failure(
      outcome.code(),
      fmt::format("analog output {} is {:.4g} {}, not {:.4g} {}: check in the installation on "
                  "the robot whether another function is assigned to it",
                  pin, run.state().analog_outputs[pin], unit, value, unit));
}

Check & check_payload(Check & check, double mass, const geometry_msgs::msg::Vector3 & center_of_gravity)
{
  return check.in_range("mass", mass, 0.0, 50.0, "kg")
      .vector("center_of_gravity", center_of_gravity, 1.0, "m");
}

Vector3 to_vector(const geometry_msgs::msg::Vector3 & vector)
{
  return {vector.x, vector.y, vector.z};
}

}  // namespace ur_ros_rtde
