#include "streaming/execute.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <future>

#include "ur_ros_rtde_trajectory/plan.hpp"

namespace ur_ros_rtde {
namespace {

using trajectory::Joints;
using trajectory::Trajectory;

constexpr std::chrono::minutes planning_timeout{2};
constexpr double same_position_tolerance = 1e-6;  // rad
constexpr double moved_tolerance = 0.01;          // rad; the first setpoint may be this far from the arm

/// Plans in a separate thread, so that feedback is published and the goal can be stopped in the meantime.
Expected<PlannedTrajectory> plan_in_background(Run & run, const Execution & execution, const Joints & start)
{
  std::stop_source stop;
  auto planning = std::async(std::launch::async, [&execution, &start, token = stop.get_token()] {
    return execution.plan(start, token);
  });
  const auto ready = [&] { return planning.wait_for(std::chrono::seconds(0)) == std::future_status::ready; };
  if (auto stop_reason = run.until(ready, planning_timeout)) {
    stop.request_stop();
    planning.wait();
    return tl::unexpected(*stop_reason);
  }
  return planning.get();
}

/// Plans the motion from `start` to the start of the trajectory. Empty if they are the same.
Expected<std::optional<Trajectory>> plan_approach(const Joints & start, const PlannedTrajectory & plan,
                                                  const Execution & execution)
{
  const Joints first = plan.trajectory.sample(0.0).position;
  if ((first - start).abs().maxCoeff() <= same_position_tolerance) {
    return std::nullopt;
  }
  if (Status near = check_start_position(first, start, execution.start_tolerance);
      !near && !execution.approach) {
    return tl::unexpected(near.error());
  }
  const trajectory::PathOptions options{.speed_fraction = execution.speed_fraction};
  return trajectory::plan_path(std::vector<Joints>{start, first},
                               trajectory::default_speed_limits(plan.limits), options)
      .map([](Trajectory approach) { return std::optional(std::move(approach)); });
}

/// Force mode may have moved the arm since the motion was planned.
Status check_still_at(const Joints & start, const Sample & sample)
{
  const double distance = (commanded_joints(sample) - start).abs().maxCoeff();
  return distance <= moved_tolerance
             ? Status()
             : failure(
                   ErrorCode::invalid_goal,
                   fmt::format("the arm has moved by {:.4f} rad since this motion was planned, at most {} "
                               "rad are allowed: end force mode, or send the goal again",
                               distance, moved_tolerance));
}

}  // namespace

Joints commanded_joints(const Sample & sample)
{
  return Eigen::Map<const Joints>(sample.target_q.data());
}

Status check_start_position(const Joints & first, const Joints & current, double tolerance)
{
  int joint = 0;
  const double distance = (first - current).abs().maxCoeff(&joint);
  if (distance <= tolerance) {
    return {};
  }
  return failure(
      ErrorCode::invalid_goal,
      fmt::format(
          "the trajectory starts with {} at {:.4f} rad, but the arm is at {:.4f} rad, {:.4f} rad "
          "away; start_tolerance is {:.4f} rad: plan from the current positions, or move to the start "
          "first",
          trajectory::joint_name(joint), first[joint], current[joint], distance, tolerance));
}

ExecutionResult execute(Run & run, const Execution & execution)
{
  const Joints start = commanded_joints(run.state());
  const auto plan = plan_in_background(run, execution, start);
  if (!plan) {
    return {plan.error(), 0.0};
  }
  const auto approach = plan_approach(start, *plan, execution);
  if (!approach) {
    return {approach.error(), 0.0};
  }
  execution.on_planned(plan->trajectory);
  if (Outcome begins = execution.wait_for_start(); !begins) {
    return {begins, 0.0};
  }
  if (Status unmoved = check_still_at(start, run.state()); !unmoved) {
    return {unmoved.error(), 0.0};
  }
  double tracking_error = 0.0;  // of the approach
  if (*approach) {
    ServoStream stream(run, execution.servo,
                       [](const Trajectory &, const StreamState &) { return Status(); });
    const Outcome approached = stream.execute(**approach, plan->limits);
    tracking_error = stream.max_tracking_error();
    if (!approached) {
      return {approached, tracking_error};
    }
  }
  ServoStream stream(run, execution.servo, execution.on_setpoint);
  Outcome outcome = stream.execute(plan->trajectory, plan->limits);
  if (outcome) {
    outcome = execution.wait_for_arrival ? execution.wait_for_arrival() : stream.finish();
  }
  return {outcome, std::max(tracking_error, stream.max_tracking_error())};
}

}  // namespace ur_ros_rtde
