#include "moveit/tolerances.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "streaming/goal_fields.hpp"

namespace ur_ros_rtde {
namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

double limit_from(double given, double default_limit)
{
  return given > 0.0 ? given : given < 0.0 ? no_limit : default_limit;
}

}  // namespace

Expected<Tolerances> Tolerances::read(std::string_view field,
                                      const std::vector<control_msgs::msg::JointTolerance> & list,
                                      const std::vector<std::string> & names, double default_position)
{
  Tolerances result{trajectory::Joints::Constant(default_position), trajectory::Joints::Constant(no_limit)};
  const auto order = joint_order(names);
  if (!order) {
    return tl::unexpected(order.error());
  }
  for (const auto & tolerance : list) {
    const auto found = std::find(names.begin(), names.end(), tolerance.name);
    if (found == names.end()) {
      return failure(ErrorCode::invalid_goal, fmt::format("{} is given for {}, joint_names are {}", field,
                                                          tolerance.name, fmt::join(names, ", ")));
    }
    if (!std::isfinite(tolerance.position) || !std::isfinite(tolerance.velocity)) {
      return failure(ErrorCode::invalid_goal,
                     fmt::format("{} of {} is {} rad, {} rad/s: set finite values", field, tolerance.name,
                                 tolerance.position, tolerance.velocity));
    }
    if (tolerance.acceleration > 0.0 || std::isnan(tolerance.acceleration)) {
      return failure(
          ErrorCode::not_supported,
          fmt::format("{} of {} limits the acceleration, which the robot does not measure: set it to 0",
                      field, tolerance.name));
    }
    const auto place = static_cast<std::size_t>(found - names.begin());
    const auto joint = std::find(order->begin(), order->end(), place) - order->begin();
    result.position[joint] = limit_from(tolerance.position, default_position);
    result.velocity[joint] = limit_from(tolerance.velocity, no_limit);
  }
  return result;
}

Status Tolerances::check(const trajectory::Joints & position_error,
                         const trajectory::Joints & velocity_error) const
{
  for (int joint = 0; joint < trajectory::joint_count; ++joint) {
    if (std::abs(position_error[joint]) > position[joint]) {
      return failure(ErrorCode::not_reached,
                     fmt::format("{} deviates by {:.4f} rad, its tolerance is {:.4f} rad",
                                 trajectory::joint_name(joint), position_error[joint], position[joint]));
    }
    if (std::abs(velocity_error[joint]) > velocity[joint]) {
      return failure(ErrorCode::not_reached,
                     fmt::format("{} deviates by {:.4f} rad/s, its tolerance is {:.4f} rad/s",
                                 trajectory::joint_name(joint), velocity_error[joint], velocity[joint]));
    }
  }
  return {};
}

}  // namespace ur_ros_rtde
