#include "move_until_wrench.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {
namespace {
constexpr int offset_packages = 10;

geometry_msgs::msg::Vector3 to_ros(const Vector3 & v)
{
  geometry_msgs::msg::Vector3 message;
  message.x = v[0];
  message.y = v[1];
  message.z = v[2];
  return message;
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
      .that(goal.axes[0] || goal.axes[1] || goal.axes[2],
            "axes is false for all axes: at least one axis has to be true")
      .above_zero("threshold", goal.threshold, part_.max_threshold, part_.unit);
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

std::optional<StopReason> MoveUntilWrench::measure_offset(const Goal & goal, Run & run, Vector3 & mean) const
{
  mean = {};
  Sample sample = run.state();
  for (int package = 0; package < offset_packages; ++package) {
    if (auto why = run.next(sample)) {
      return why;
    }
    const Vector3 now = measure(goal, sample);
    for (std::size_t i = 0; i < mean.size(); ++i) {
      mean[i] += now[i] / offset_packages;
    }
  }
  return std::nullopt;
}

Outcome MoveUntilWrench::wait_for_threshold(const Goal & goal, Run & run, const Vector3 & offset) const
{
  const Sample start = run.state();
  for (Sample sample = start; true;) {
    if (auto why = run.next(sample)) {
      return *why;
    }
    Vector3 now = measure(goal, sample);
    std::transform(now.begin(), now.end(), offset.begin(), now.begin(), std::minus<>());
    run.feedback().measured = run.result().measured = to_ros(now);
    const double magnitude = length(now);
    if (!(magnitude < goal.threshold)) {  // also true for NaN
      return std::isfinite(magnitude)
                 ? Outcome::success(fmt::format("stopped by {:.1f} {}", magnitude, part_.unit))
                 : Outcome::failure(ErrorCode::not_supported,
                                    "the robot does not report the force on its TCP");
    }
    const double way = distance(start.actual_tcp_pose, sample.actual_tcp_pose);
    const double time = sample.controller_time - start.controller_time;
    run.progress(std::clamp(std::max(way / goal.distance, time / goal.timeout), 0.0, 1.0));
    if (way >= goal.distance) {
      return Outcome::failure(ErrorCode::not_reached,
                              fmt::format("threshold of {} {} not reached within {} m, last value: {:.1f} {}",
                                          goal.threshold, part_.unit, goal.distance, magnitude, part_.unit));
    }
    if (time >= goal.timeout) {
      return Outcome::failure(ErrorCode::timeout,
                              fmt::format("threshold of {} {} not reached within {} s, last value: {:.1f} {}",
                                          goal.threshold, part_.unit, goal.timeout, magnitude, part_.unit));
    }
  }
}

Outcome MoveUntilWrench::run(const Goal & goal, Run & run)
{
  Vector3 offset;
  if (auto why = measure_offset(goal, run, offset)) {
    return *why;
  }
  run.control()->speedL(to_ur(goal.twist), goal.acceleration, 0.0);
  return wait_for_threshold(goal, run, offset);  // the base class stops the arm
}

}  // namespace ur_ros_rtde
