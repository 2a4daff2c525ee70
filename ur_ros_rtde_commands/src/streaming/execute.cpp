#include "streaming/execute.hpp"

#include <fmt/format.h>

#include <future>

#include "ur_ros_rtde_trajectory/plan.hpp"

namespace ur_ros_rtde {
namespace {

using trajectory::Joints;
using trajectory::Trajectory;

constexpr std::chrono::minutes planning_limit{2};
constexpr double same_place = 1e-6;  // rad

/// Feedback goes on, and the goal can be ended, while it is planned.
Expected<Planned> plan_meanwhile(Run & run, const Execution & execution, const Joints & start)
{
  std::stop_source stop;
  auto planning = std::async(std::launch::async, [&execution, &start, token = stop.get_token()] {
    return execution.plan(start, token);
  });
  const auto ready = [&] { return planning.wait_for(std::chrono::seconds(0)) == std::future_status::ready; };
  if (auto why = run.until(ready, planning_limit)) {
    stop.request_stop();
    planning.wait();
    return tl::unexpected(*why);
  }
  return planning.get();
}

/// From where the arm is to where the plan begins; none when that is the same.
Expected<std::optional<Trajectory>> plan_approach(const Joints & start, const Planned & plan,
                                                  const Execution & execution)
{
  const Joints first = plan.trajectory.sample(0.0).position;
  if ((first - start).abs().maxCoeff() <= same_place) {
    return std::nullopt;
  }
  if (Status near = check_start_position(first, start, execution.start_tolerance);
      !near && !execution.approach) {
    return tl::unexpected(near.error());
  }
  const trajectory::PathOptions options{.speed_fraction = execution.speed_fraction};
  return trajectory::plan_path(std::vector<Joints>{start, first}, trajectory::slow_limits(plan.limits),
                               options)
      .map([](Trajectory approach) { return std::optional(std::move(approach)); });
}

}  // namespace

Joints commanded_joints(const Sample & sample)
{
  return Eigen::Map<const Joints>(sample.target_q.data());
}

Status check_start_position(const Joints & first, const Joints & here, double tolerance)
{
  int joint = 0;
  const double distance = (first - here).abs().maxCoeff(&joint);
  if (distance <= tolerance) {
    return {};
  }
  return failure(
      ErrorCode::invalid_goal,
      fmt::format("the trajectory begins with {} at {:.4f} rad, the arm is at {:.4f} rad, {:.4f} rad "
                  "away, start_tolerance is {:.4f} rad: plan from where the arm is, or go there first",
                  trajectory::joint_name(joint), first[joint], here[joint], distance, tolerance));
}

ExecutionResult execute(Run & run, const Execution & execution)
{
  const Joints start = commanded_joints(run.state());
  const auto plan = plan_meanwhile(run, execution, start);
  if (!plan) {
    return {plan.error(), 0.0};
  }
  const auto approach = plan_approach(start, *plan, execution);
  if (!approach) {
    return {approach.error(), 0.0};
  }
  execution.planned(plan->trajectory);
  if (*approach) {
    ServoStream stream(run, execution.servo,
                       [](const Trajectory &, const StreamState &) { return Status(); });
    if (Outcome there = stream.drive(**approach, plan->limits); !there) {
      return {there, stream.max_tracking_error()};
    }
  }
  ServoStream stream(run, execution.servo, execution.watch);
  Outcome outcome = stream.drive(plan->trajectory, plan->limits);
  if (outcome) {
    outcome = execution.arrive ? execution.arrive() : stream.settle();
  }
  return {outcome, stream.max_tracking_error()};
}

}  // namespace ur_ros_rtde
