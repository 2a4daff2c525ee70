#include "safety/limit_monitor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinematics/forward_kinematics.hpp"

namespace ur_simulator {
namespace {

constexpr double position_tolerance = 0.02;  // rad: the lag of the servo loops may exceed a limit

/// The joint, 0..5, with the largest magnitude.
std::int32_t largest(const Vector6 & values)
{
  Eigen::Index joint = 0;
  values.cwiseAbs().maxCoeff(&joint);
  return static_cast<std::int32_t>(joint);
}

}  // namespace

std::optional<ExceededLimit> LimitMonitor::check(const SafetyLimits & limits, const ControllerState & state)
{
  auto force = check_force(limits, state);
  if (auto joint = check_joints(limits, state.actual)) {
    return joint;
  }
  if (state.joint_deviation_ratio >= 1.0) {
    return ExceededLimit{
        error_codes::position_deviates(largest(state.target.position - state.actual.position),
                                       state.payload.mass > 0.0),
        fmt::format("the joints deviate from their path: {:.2f} times the allowed deviation",
                    state.joint_deviation_ratio)};
  }
  const double speed = state.actual_tcp_speed.head<3>().norm();
  if (speed > limits.tool_speed) {
    return ExceededLimit{
        error_codes::unnumbered_protective_stop,
        fmt::format("tool speed {:.2f} m/s is over the safety limit of {:.2f} m/s; move slower", speed,
                    limits.tool_speed)};
  }
  return force;
}

std::optional<ExceededLimit> LimitMonitor::check_joints(const SafetyLimits & limits,
                                                        const JointState & joints) const
{
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double position = joints.position[i];
    if (position < model_.position_min[i] - position_tolerance ||
        position > model_.position_max[i] + position_tolerance) {
      return ExceededLimit{
          error_codes::close_to_joint_limits,
          fmt::format("joint {} at {:.4f} rad is beyond its position limits [{:.4f}, {:.4f}]", i, position,
                      model_.position_min[i], model_.position_max[i])};
    }
    const double speed_limit = model_.velocity_max[i] * (1.0 + limits.joint_speed_margin);
    if (std::abs(joints.velocity[i]) > speed_limit) {
      return ExceededLimit{
          error_codes::unnumbered_protective_stop,
          fmt::format("joint {} turns at {:.3f} rad/s, over its safety limit of {:.3f} rad/s", i,
                      joints.velocity[i], speed_limit)};
    }
  }
  return std::nullopt;
}

void LimitMonitor::tolerate_present_force()
{
  tolerate_next_force_ = true;
}

ErrorCode LimitMonitor::collision_code(const ControllerState & state) const
{
  const Vector6 torques =
      jacobian(model_, state.actual.position, state.tcp_offset).transpose() * state.contact_wrench;
  return error_codes::collision_detected_by(largest(torques), state.payload.mass > 0.0);
}

std::optional<ExceededLimit> LimitMonitor::check_force(const SafetyLimits & limits,
                                                       const ControllerState & state)
{
  constexpr double max_increase = 50.0;  // N above the tolerated force
  const double force = state.contact_wrench.head<3>().norm();
  const bool was_tolerated = tolerate_next_force_ || tolerated_force_ > limits.tool_force;
  tolerated_force_ = tolerate_next_force_ ? force : std::min(tolerated_force_, force);
  tolerate_next_force_ = false;
  if (was_tolerated) {
    filtered_force_ = std::min(filtered_force_, force);  // the tolerated force does not remain in the filter
  }
  filtered_force_ +=
      (1.0 - std::exp(-cycle_time_ / limits.tool_force_filter_time)) * (force - filtered_force_);
  const bool tolerated = tolerated_force_ > limits.tool_force;
  const double sustained_limit = tolerated ? tolerated_force_ + max_increase : limits.tool_force;
  const double peak_limit = std::max(sustained_limit, limits.tool_force_peak);
  force_ratio_ = std::max(filtered_force_ / sustained_limit, force / peak_limit);
  if (filtered_force_ > sustained_limit) {
    return ExceededLimit{
        collision_code(state),
        fmt::format(
            "tool force {:.0f} N, sustained, is over the safety limit of {:.0f} N; release the tool, or "
            "press less",
            filtered_force_, sustained_limit)};
  }
  if (force > peak_limit) {
    return ExceededLimit{
        collision_code(state),
        fmt::format("tool force {:.0f} N is over the peak of {:.0f} N: collision", force, peak_limit)};
  }
  return std::nullopt;
}

}  // namespace ur_simulator
