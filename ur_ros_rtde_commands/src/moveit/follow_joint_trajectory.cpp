#include <fmt/format.h>

#include <algorithm>
#include <control_msgs/action/follow_joint_trajectory.hpp>
#include <limits>

#include "moveit/tolerances.hpp"
#include "streaming/execute.hpp"
#include "streaming/goal_fields.hpp"
#include "streaming/timed_trajectory.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {
namespace {

using Action = control_msgs::action::FollowJointTrajectory;
using trajectory::Joints;

constexpr double default_goal_tolerance = 0.01;      // rad
constexpr double default_goal_time_tolerance = 2.0;  // s
constexpr double longest_goal_time = 86400.0;        // s, without a tolerance
constexpr double start_tolerance = 0.02;             // rad; MoveIt checks its own, too
constexpr double max_start_delay = 60.0;             // s from now
constexpr std::chrono::minutes longest_wait{10};     // for the start, of a clock that is slower than this one
constexpr double velocity_reserve = 1.05;  // a spline between points at the limit exceeds it slightly
constexpr auto feedback_period = std::chrono::milliseconds(50);

template <typename Stamp>
double seconds(const Stamp & stamp)
{
  return static_cast<double>(stamp.sec) + 1e-9 * static_cast<double>(stamp.nanosec);
}

bool is_zero(const builtin_interfaces::msg::Time & stamp)
{
  return stamp.sec == 0 && stamp.nanosec == 0;
}

/// MoveIt has computed the times with its own limits. Only the physical limits of the arm are checked here.
trajectory::Limits widest_limits(const ArmLimits & arm)
{
  trajectory::Limits limits =
      trajectory::make_limits(arm, trajectory::max_goal_acceleration, trajectory::max_goal_jerk);
  limits.velocity *= velocity_reserve;
  return limits;
}

/// The limits of a stop during the trajectory: those that the plan itself uses, at least the defaults.
trajectory::Limits limits_for_stops(const trajectory::Trajectory & plan, trajectory::Limits limits)
{
  if (const auto use = plan.verify(limits)) {
    limits.acceleration = (limits.acceleration * use->acceleration).max(trajectory::default_acceleration);
    limits.jerk = (limits.jerk * use->jerk).max(trajectory::default_jerk);
  }
  return limits;
}

/// The feedback of control_msgs has the field `index` since 2025.
template <typename Feedback>
void set_index(Feedback & feedback, std::size_t index)
{
  if constexpr (requires { feedback.index; }) {
    feedback.index = static_cast<std::int32_t>(index);
  }
}

trajectory_msgs::msg::JointTrajectoryPoint to_point(const std::array<std::size_t, 6> & order, double time,
                                                    const Joints & position, const Joints & velocity)
{
  trajectory_msgs::msg::JointTrajectoryPoint point;
  point.positions.resize(order.size());
  point.velocities.resize(order.size());
  for (std::size_t joint = 0; joint < order.size(); ++joint) {
    point.positions[order[joint]] = position[static_cast<int>(joint)];
    point.velocities[order[joint]] = velocity[static_cast<int>(joint)];
  }
  const auto whole = static_cast<std::int32_t>(time);
  point.time_from_start.sec = whole;
  point.time_from_start.nanosec = static_cast<std::uint32_t>((time - whole) * 1e9);
  return point;
}

}  // namespace

/// Behaves like the joint trajectory controller of ros2_control, which MoveIt uses. docs/use/trajectory.md
/// describes the differences.
class FollowJointTrajectory : public Command<Action> {
 public:
  void on_load(CommandHost & host) override;

 private:
  CommandTraits traits() const override { return {.preempts_self = true}; }
  void check(const Goal & goal, Check & check) const override;
  Outcome run(const Goal & goal, Run & run) override;
  void fill_result(const Outcome & outcome, Result & result) const override;

  double seconds_until(const builtin_interfaces::msg::Time & stamp) const
  {
    return is_zero(stamp) ? 0.0 : seconds(stamp) - seconds(host_->node().now());
  }
  void check_time(const Goal & goal, Check & check) const;
  Expected<PlannedTrajectory> plan(const Goal & goal, const Joints & start) const;
  Outcome wait_for_start(const Goal & goal, Run & run) const;
  void publish_feedback_at(const Goal & goal, Run & run, std::size_t index, const StreamState & state) const;
  static Outcome wait_for_arrival(const Goal & goal, Run & run, const Tolerances & tolerances,
                                  const Joints & end);

  CommandHost * host_ = nullptr;
  ServoSettings servo_;
};

void FollowJointTrajectory::on_load(CommandHost & host)
{
  host_ = &host;
  const auto declare = [&](const char * what, double value, double low, double high, const char * text) {
    rcl_cxx::ParameterDescriptor options;
    options.description = text;
    options.read_only = true;
    options.floating_point_range = rcl_cxx::FloatingPointRange{low, high};
    return host.node().declare_parameter(std::string("follow_joint_trajectory.") + what, value, options);
  };
  servo_.parameters.lookahead_time =
      declare("lookahead_time", 0.03, 0.03, 0.2, "s: lookahead of the smoothing in the controller");
  servo_.parameters.gain = declare("gain", 2000.0, 100.0, 2000.0, "of the controller's position control");
  servo_.max_tracking_error =
      declare("max_tracking_error", 0.3, 0.001, 3.14,
              "rad: above this error the goal is aborted and the arm stops, regardless of "
              "the tolerances of the goal");
}

void FollowJointTrajectory::check_time(const Goal & goal, Check & check) const
{
  const double begin = seconds_until(goal.trajectory.header.stamp);
  const double end = begin + seconds(goal.trajectory.points.back().time_from_start);
  check
      .that(end >= 0.0 || is_zero(goal.trajectory.header.stamp),
            fmt::format(
                "trajectory.header.stamp is {:.3f} s ago, after the end of the trajectory: set the stamp to "
                "0 to start at once",
                -begin))
      .that(
          begin <= max_start_delay,
          fmt::format("trajectory.header.stamp is {:.1f} s ahead, it may be {:.0f} s ahead at most: the arm "
                      "would be taken for so long",
                      begin, max_start_delay));
}

void FollowJointTrajectory::check(const Goal & goal, Check & check) const
{
  check.that(goal.multi_dof_trajectory.points.empty() && goal.component_path_tolerance.empty() &&
                 goal.component_goal_tolerance.empty(),
             "multi_dof_trajectory and its tolerances are not empty: the arm has single joints only",
             ErrorCode::not_supported);
  if (!check.ok() || goal.trajectory.points.empty()) {
    return;  // an empty trajectory stops the arm
  }
  check.that(!goal.trajectory.joint_names.empty(),
             "trajectory.joint_names is empty: set the names of the joints");
  for (const auto & [field, list] : {std::pair{"path_tolerance", &goal.path_tolerance},
                                     std::pair{"goal_tolerance", &goal.goal_tolerance}}) {
    if (check.ok()) {
      require(check, Tolerances::read(field, *list, goal.trajectory.joint_names, default_goal_tolerance)
                         .map([](const Tolerances &) {}));
    }
  }
  if (!check.ok()) {
    return;
  }
  check_time(goal, check);
  check_timed_trajectory(check, goal.trajectory, widest_limits(host_->limits()), start_tolerance,
                         host_->options().tf_prefix);
}

Expected<PlannedTrajectory> FollowJointTrajectory::plan(const Goal & goal, const Joints & start) const
{
  const trajectory::Limits limits = widest_limits(host_->limits());
  return plan_timed_trajectory(goal.trajectory, start, limits).map([&](trajectory::Trajectory plan) {
    return PlannedTrajectory{plan, limits_for_stops(plan, limits)};
  });
}

Outcome FollowJointTrajectory::run(const Goal & goal, Run & run)
{
  if (goal.trajectory.points.empty()) {
    return Outcome::success("the trajectory is empty: the arm is at rest");
  }
  const auto & names = goal.trajectory.joint_names;
  const auto path =
      Tolerances::read("path_tolerance", goal.path_tolerance, names, std::numeric_limits<double>::infinity());
  const auto end = Tolerances::read("goal_tolerance", goal.goal_tolerance, names, default_goal_tolerance);
  if (!path || !end) {
    return path ? end.error() : path.error();
  }
  Joints last = Joints::Zero();
  Execution execution;
  execution.servo = servo_;
  execution.start_tolerance = start_tolerance;
  execution.plan = [&](const Joints & start, const std::stop_token &) { return plan(goal, start); };
  execution.on_planned = [&](const trajectory::Trajectory & plan) {
    last = plan.sample(plan.duration()).position;
  };
  execution.wait_for_start = [&] { return wait_for_start(goal, run); };
  auto next_feedback = std::chrono::steady_clock::now();
  execution.on_setpoint = [&](const trajectory::Trajectory & plan, const StreamState & state) {
    run.progress(plan.progress(state.time));
    if (const auto now = std::chrono::steady_clock::now(); now >= next_feedback) {
      next_feedback = now + feedback_period;
      publish_feedback_at(goal, run, std::min(plan.waypoint_at(state.time) + 1, plan.waypoint_count() - 1),
                          state);
    }
    return path->check(state.position_error, state.velocity_error);
  };
  execution.wait_for_arrival = [&] { return wait_for_arrival(goal, run, *end, last); };
  return execute(run, execution).outcome;
}

/// In ROS time, which may pass at another rate than that of this host.
Outcome FollowJointTrajectory::wait_for_start(const Goal & goal, Run & run) const
{
  return run.expect([&] { return seconds_until(goal.trajectory.header.stamp) <= 0.0; }, longest_wait,
                    "the time of trajectory.header.stamp has not come");
}

void FollowJointTrajectory::publish_feedback_at(const Goal & goal, Run & run, std::size_t index,
                                                const StreamState & state) const
{
  Feedback & feedback = run.feedback();
  const auto order = joint_order(goal.trajectory.joint_names);
  const Joints position = Eigen::Map<const Joints>(state.sample.actual_q.data());
  const Joints velocity = Eigen::Map<const Joints>(state.sample.actual_qd.data());
  feedback.header.stamp = host_->node().now();
  feedback.joint_names = goal.trajectory.joint_names;
  feedback.desired = to_point(*order, state.time, state.desired.position, state.desired.velocity);
  feedback.actual = to_point(*order, state.time, position, velocity);
  feedback.error =
      to_point(*order, state.time, state.desired.position - position, state.desired.velocity - velocity);
  set_index(feedback, index);
  run.publish();
}

Outcome FollowJointTrajectory::wait_for_arrival(const Goal & goal, Run & run, const Tolerances & tolerances,
                                                const Joints & end)
{
  const double given = seconds(goal.goal_time_tolerance);
  const double limit = given > 0.0 ? given : given < 0.0 ? longest_goal_time : default_goal_time_tolerance;
  Status held;
  const auto arrived = [&] {
    const Sample sample = run.state();
    held = tolerances.check(end - Eigen::Map<const Joints>(sample.actual_q.data()),
                            -Eigen::Map<const Joints>(sample.actual_qd.data()));
    return static_cast<bool>(held);
  };
  if (auto stop_reason =
          run.until(arrived, std::chrono::nanoseconds(static_cast<std::int64_t>(limit * 1e9)))) {
    if (stop_reason->code != ErrorCode::timeout) {
      return *stop_reason;
    }
    run.result().error_code = Result::GOAL_TOLERANCE_VIOLATED;
    return Outcome::failure(ErrorCode::not_reached, fmt::format("{:.2f} s after the end of the trajectory {}",
                                                                limit, held.error().message));
  }
  if (auto why = run.is_compliant() ? std::nullopt : run.until_standstill()) {
    return *why;
  }
  run.control()->servoStop();
  return Outcome::success();
}

void FollowJointTrajectory::fill_result(const Outcome & outcome, Result & result) const
{
  if (outcome || outcome.code() == ErrorCode::canceled) {
    result.error_code = Result::SUCCESSFUL;
  } else if (outcome.code() != ErrorCode::not_reached) {
    result.error_code = Result::INVALID_GOAL;
  } else if (result.error_code != Result::GOAL_TOLERANCE_VIOLATED) {
    result.error_code = Result::PATH_TOLERANCE_VIOLATED;
  }
  result.error_string = outcome.message();
}

UR_ROS_RTDE_EXPORT(FollowJointTrajectory, "follow_joint_trajectory")

}  // namespace ur_ros_rtde
