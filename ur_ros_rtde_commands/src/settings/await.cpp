#include "settings/await.hpp"

#include <fmt/format.h>

namespace ur_ros_rtde {

Outcome switch_output(Run & run, unsigned number, bool state,
                      const std::function<bool(ur_rtde::RTDEIOInterface &)> & set)
{
  if (!set(*run.io().hold())) {
    return Outcome::failure(ErrorCode::link_lost, "the command could not be sent to the robot: try again");
  }
  const auto is_set = [&] { return (((run.state().digital_outputs >> number) & 1U) != 0) == state; };
  return run.expect(
      is_set, setting_limit,
      fmt::format("digital output {} stays {}: the installation on the robot may have given it another task",
                  number, state ? "off" : "on"));
}

Outcome set_analog_output(Run & run, unsigned pin, double value, double tolerance, const char * unit,
                          const std::function<bool(ur_rtde::RTDEIOInterface &)> & set)
{
  if (!set(*run.io().hold())) {
    return Outcome::failure(ErrorCode::link_lost, "the command could not be sent to the robot: try again");
  }
  const auto is_set = [&] { return std::abs(run.state().analog_outputs[pin] - value) <= tolerance; };
  Outcome outcome = run.expect(is_set, setting_limit, "");
  if (outcome.code() != ErrorCode::rejected_by_robot) {
    return outcome;
  }
  return Outcome::failure(
      outcome.code(),
      fmt::format("analog output {} is {:.4g} {}, not {:.4g}: the installation on the robot may have given "
                  "it another task",
                  pin, run.state().analog_outputs[pin], unit, value));
}

bool payload_is(const Sample & sample, double mass, const geometry_msgs::msg::Vector3 & center_of_gravity)
{
  constexpr double tolerance = 1e-3;  // kg, m
  const Vector3 & set = sample.payload_cog;
  const auto & wanted = center_of_gravity;
  return std::isnan(sample.payload) ||
         (std::abs(sample.payload - mass) < tolerance &&
          std::hypot(set[0] - wanted.x, set[1] - wanted.y, set[2] - wanted.z) < tolerance);
}

std::vector<double> center_for_ur(const geometry_msgs::msg::Vector3 & center_of_gravity)
{
  const auto & cog = center_of_gravity;
  const bool zero = cog.x == 0.0 && cog.y == 0.0 && cog.z == 0.0;
  return {cog.x, cog.y, zero ? 1e-9 : cog.z};
}

}  // namespace ur_ros_rtde
