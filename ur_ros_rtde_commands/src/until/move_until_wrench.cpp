#include "move_until_wrench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {
namespace {
constexpr int packages_at_rest = 10;

geometry_msgs::msg::Vector3 to_ros(const Vector3 & v)
{
  geometry_msgs::msg::Vector3 message;
  message.x = v[0];
  message.y = v[1];
  message.z = v[2];
  return message;
}

/// std::hypot of three may lose a NaN.
double length(const Vector3 & v)
{
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

double distance(const Vector6 & from, const Vector6 & to)
{
  return length({to[0] - from[0], to[1] - from[1], to[2] - from[2]});
}
}  // namespace

void MoveUntilWrench::check(const Goal & goal, Check & check) const
{
  check.twist("twist", goal.twist)
      .above_zero("acceleration", goal.acceleration, 150.0, "m/s^2")
      .in_range("deceleration", goal.deceleration, 0.1, 150.0, "m/s^2")
      .above_zero("timeout", goal.timeout, 3600.0, "s")
      .above_zero("distance", goal.distance, 3.0, "m")
      .in_range("frame", goal.frame, Goal::BASE, Goal::TOOL)
      .that(goal.axes[0] || goal.axes[1] || goal.axes[2], "axes are all false: one at least has to count")
      .above_zero("threshold", goal.threshold, part_.highest_threshold, part_.unit);
}

Vector3 MoveUntilWrench::measure(const Goal & goal, const Sample & sample) const
{
  const Vector6 wrench = goal.frame == Goal::TOOL ? tcp_frame_force(sample) : sample.actual_tcp_force;
  Vector3 part{};
  for (std::size_t i = 0; i < part.size(); ++i) {
    part[i] = goal.axes[i] ? wrench[part_.first + i] : 0.0;
  }
  return part;
}

std::optional<StopReason> MoveUntilWrench::rest(const Goal & goal, Run & run, Vector3 & mean) const
{
  mean = {};
  Sample sample = run.state();
  for (int package = 0; package < packages_at_rest; ++package) {
    if (auto why = run.next(sample)) {
      return why;
    }
    const Vector3 now = measure(goal, sample);
    for (std::size_t i = 0; i < mean.size(); ++i) {
      mean[i] += now[i] / packages_at_rest;
    }
  }
  return std::nullopt;
}

Outcome MoveUntilWrench::watch(const Goal & goal, Run & run, const Vector3 & zero) const
{
  const Sample start = run.state();
  for (Sample sample = start; true;) {
    if (auto why = run.next(sample)) {
      return *why;
    }
    Vector3 now = measure(goal, sample);
    std::transform(now.begin(), now.end(), zero.begin(), now.begin(), std::minus<>());
    run.feedback().measured = run.result().measured = to_ros(now);
    const double size = length(now);
    if (!(size < goal.threshold)) {  // NaN stops, too
      return std::isfinite(size) ? Outcome::success(fmt::format("stopped by {:.1f} {}", size, part_.unit))
                                 : Outcome::failure(ErrorCode::not_supported,
                                                    "the robot does not report the force on its TCP");
    }
    const double way = distance(start.actual_tcp_pose, sample.actual_tcp_pose);
    const double time = sample.controller_time - start.controller_time;
    run.progress(std::clamp(std::max(way / goal.distance, time / goal.timeout), 0.0, 1.0));
    if (way >= goal.distance) {
      return Outcome::failure(ErrorCode::not_reached,
                              fmt::format("no {} {} within {} m, the last were {:.1f} {}", goal.threshold,
                                          part_.unit, goal.distance, size, part_.unit));
    }
    if (time >= goal.timeout) {
      return Outcome::failure(ErrorCode::timeout,
                              fmt::format("no {} {} within {} s, the last were {:.1f} {}", goal.threshold,
                                          part_.unit, goal.timeout, size, part_.unit));
    }
  }
}

Outcome MoveUntilWrench::run(const Goal & goal, Run & run)
{
  Vector3 zero;
  if (auto why = rest(goal, run, zero)) {
    return *why;
  }
  run.control()->speedL(to_ur(goal.twist), goal.acceleration, 0.0);
  const Outcome outcome = watch(goal, run, zero);
  if (!outcome) {
    return outcome;  // and the base class stops the arm
  }
  run.control()->speedStop(goal.deceleration);
  const auto why = run.until_standstill();
  return why ? Outcome(*why) : outcome;
}

}  // namespace ur_ros_rtde
