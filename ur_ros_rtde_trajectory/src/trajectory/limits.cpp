#include "ur_ros_rtde_trajectory/limits.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "trajectory/check_positions.hpp"
#include "ur_ros_rtde_trajectory/default_speeds.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

// Values outside this range are mistakes: they lead to motions that last for years or have no accuracy.
constexpr double smallest = 1e-4;
constexpr double largest = 1e7;

Status check_range(std::string_view field, const Joints & values, bool may_be_infinite)
{
  for (int j = 0; j < joint_count; ++j) {
    const bool fine =
        (values[j] >= smallest && values[j] <= largest) || (may_be_infinite && values[j] == unlimited);
    if (!fine) {
      return failure(
          ErrorCode::invalid_goal,
          fmt::format("{} limit of {} is {}: give a number from {} to {}{}", field, joint_name(j), values[j],
                      smallest, largest, may_be_infinite ? ", or infinity for none" : ""));
    }
  }
  return {};
}

}  // namespace

Limits make_limits(const ArmLimits & arm, double acceleration, double jerk)
{
  Limits limits;
  limits.position_max = Eigen::Map<const Joints>(arm.position.data());
  limits.position_min = -limits.position_max;
  limits.velocity = Eigen::Map<const Joints>(arm.velocity.data());
  limits.acceleration.setConstant(acceleration);
  limits.jerk.setConstant(jerk);
  return limits;
}

Limits default_speed_limits(Limits limits)
{
  limits.velocity = limits.velocity.min(default_joint_speed);
  limits.acceleration = limits.acceleration.min(default_joint_acceleration);
  return limits;
}

Status check(const Limits & limits)
{
  for (int j = 0; j < joint_count; ++j) {
    if (!(limits.position_min[j] < limits.position_max[j])) {
      return failure(ErrorCode::invalid_goal,
                     fmt::format("position limits of {} are {} to {} rad: the first must be below the second",
                                 joint_name(j), limits.position_min[j], limits.position_max[j]));
    }
  }
  if (auto status = check_range("velocity", limits.velocity, false); !status) {
    return status;
  }
  if (auto status = check_range("acceleration", limits.acceleration, false); !status) {
    return status;
  }
  return check_range("jerk", limits.jerk, true);
}

Status check_positions(std::string_view field, const Joints & positions, const Limits & limits)
{
  for (int j = 0; j < joint_count; ++j) {
    const bool within = positions[j] >= limits.position_min[j] && positions[j] <= limits.position_max[j];
    if (!within) {  // or not a number
      return failure(
          ErrorCode::invalid_goal,
          fmt::format("{} of {} is {:.6g} rad, outside its limits {:.6g} to {:.6g} rad", field, joint_name(j),
                      positions[j], limits.position_min[j], limits.position_max[j]));
    }
  }
  return {};
}

std::string_view joint_name(int joint)
{
  static constexpr std::array<std::string_view, joint_count> names{
      "shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint",
      "wrist_1_joint",      "wrist_2_joint",       "wrist_3_joint"};
  return names.at(static_cast<std::size_t>(joint));
}

Expected<Joints> to_joints(std::string_view field, const std::vector<double> & values)
{
  if (values.size() != joint_count) {
    return failure(ErrorCode::invalid_goal,
                   fmt::format("{} has {} values, the arm has {} joints", field, values.size(), joint_count));
  }
  for (int j = 0; j < joint_count; ++j) {
    if (!std::isfinite(values[static_cast<std::size_t>(j)])) {
      return failure(ErrorCode::invalid_goal,
                     fmt::format("{} of {} is {}: give a finite number", field, joint_name(j),
                                 values[static_cast<std::size_t>(j)]));
    }
  }
  return Eigen::Map<const Joints>(values.data());
}

}  // namespace ur_ros_rtde::trajectory
