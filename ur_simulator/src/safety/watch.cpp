#include "safety/watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ur_simulator {
namespace {

constexpr double position_tolerance = 0.02;  // rad: the servo loops may pass a limit by their lag

}  // namespace

std::optional<std::string> LimitWatch::check(const SafetyLimits & limits, const ControllerState & state)
{
  auto force = check_force(limits, state);
  if (auto joint = check_joints(limits, state.actual)) {
    return joint;
  }
  const double speed = state.actual_tcp_speed.head<3>().norm();
  if (speed > limits.tool_speed) {
    return fmt::format("tool speed {:.2f} m/s is over the safety limit of {:.2f} m/s; move slower", speed,
                       limits.tool_speed);
  }
  return force;
}

std::optional<std::string> LimitWatch::check_joints(const SafetyLimits & limits,
                                                    const JointState & joints) const
{
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double position = joints.position[i];
    if (position < model_.position_min[i] - position_tolerance ||
        position > model_.position_max[i] + position_tolerance) {
      return fmt::format("joint {} at {:.4f} rad is beyond its position limits [{:.4f}, {:.4f}]", i, position,
                         model_.position_min[i], model_.position_max[i]);
    }
    const double speed_limit = model_.velocity_max[i] * (1.0 + limits.joint_speed_margin);
    if (std::abs(joints.velocity[i]) > speed_limit) {
      return fmt::format("joint {} turns at {:.3f} rad/s, over its safety limit of {:.3f} rad/s", i,
                         joints.velocity[i], speed_limit);
    }
  }
  return std::nullopt;
}

void LimitWatch::relent()
{
  relenting_ = true;
}

std::optional<std::string> LimitWatch::check_force(const SafetyLimits & limits, const ControllerState & state)
{
  constexpr double harder = 50.0;  // N that a forgiven force may grow by
  const double force = state.contact_wrench.head<3>().norm();
  const bool was_forgiven = relenting_ || forgiven_ > limits.tool_force;
  forgiven_ = relenting_ ? force : std::min(forgiven_, force);
  relenting_ = false;
  if (was_forgiven) {
    filtered_force_ = std::min(filtered_force_, force);  // what was forgiven does not linger in the filter
  }
  filtered_force_ += (1.0 - std::exp(-cycle_time_ / limits.tool_force_time)) * (force - filtered_force_);
  const bool forgiven = forgiven_ > limits.tool_force;
  const double sustained_limit = forgiven ? forgiven_ + harder : limits.tool_force;
  const double peak_limit = std::max(sustained_limit, limits.tool_force_peak);
  if (filtered_force_ > sustained_limit) {
    return fmt::format(
        "tool force {:.0f} N, sustained, is over the safety limit of {:.0f} N; release the tool, or press "
        "less",
        filtered_force_, sustained_limit);
  }
  if (force > peak_limit) {
    return fmt::format("tool force {:.0f} N is over the peak of {:.0f} N: collision", force, peak_limit);
  }
  return std::nullopt;
}

}  // namespace ur_simulator
