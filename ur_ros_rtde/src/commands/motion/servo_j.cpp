#include <algorithm>
#include <cmath>
#include <ur_ros_rtde_msgs/action/servo_j.hpp>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {
namespace {
/// From rest to rest, without a jump in the acceleration (minimum jerk); its highest speed is 15/8 of the
/// mean.
double smooth_step(double u)
{
  return u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
}
constexpr double smooth_step_peak = 15.0 / 8.0;
constexpr double tolerance = 0.01;  // rad
constexpr std::chrono::seconds settling_limit{2};

double largest_error(const std::vector<double> & target, const Vector6 & actual)
{
  double largest = 0.0;
  for (std::size_t i = 0; i < actual.size(); ++i) {
    largest = std::max(largest, std::abs(target[i] - actual[i]));
  }
  return largest;
}
}  // namespace

class ServoJ : public Command<ur_ros_rtde_msgs::action::ServoJ> {
  void check(const Goal & goal, Check & check) const override
  {
    check.joints("joint_positions", goal.joint_positions)
        .in_range("time", goal.time, 0.01, 600.0, "s")
        .in_range("lookahead_time", goal.lookahead_time, 0.03, 0.2, "s")
        .in_range("gain", goal.gain, 100.0, 2000.0)
        .in_range("deceleration", goal.deceleration, 0.1, 40.0, "rad/s^2")
        .reachable_in("joint_positions", goal.joint_positions, goal.time, smooth_step_peak);
  }

  StopOptions stop_options(const Goal & goal) const override
  {
    StopOptions options;
    options.joint_deceleration = goal.deceleration;
    options.linear_deceleration = goal.deceleration;  // of the servo stop
    return options;
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    if (auto why = follow(goal, run)) {
      return *why;
    }
    const auto arrived = [&] {
      return largest_error(goal.joint_positions, run.state().actual_q) < tolerance;
    };
    // Servo control lags behind by lookahead_time.
    const Outcome outcome =
        run.expect(arrived, settling_limit, "the arm did not get to joint_positions", ErrorCode::not_reached);
    run.control()->servoStop(goal.deceleration);
    return outcome;
  }

  /// A target for each control cycle. A host that comes late goes on from where it was: the arm is slower
  /// then, never faster.
  static std::optional<Interruption> follow(const Goal & goal, Run & run)
  {
    const auto version = run.robot().version();
    const double cycle = 1.0 / (version ? version->frequency() : 500.0);
    const Vector6 start = run.state().actual_q;
    std::vector<double> target(start.begin(), start.end());
    Sample sample = run.state();
    for (double time = 0.0; time < goal.time;) {
      const double before = sample.controller_time;
      if (auto why = run.next(sample)) {
        return why;
      }
      time += std::clamp(sample.controller_time - before, 0.0, 2.0 * cycle);
      run.progress(std::min(time / goal.time, 1.0));
      for (std::size_t i = 0; i < target.size(); ++i) {
        target[i] = start[i] + smooth_step(run.progress()) * (goal.joint_positions[i] - start[i]);
      }
      run.control()->servoJ(target, 0.0, 0.0, cycle, goal.lookahead_time, goal.gain);
    }
    return std::nullopt;
  }
};

UR_ROS_RTDE_EXPORT(ServoJ, "servo_j")

}  // namespace ur_ros_rtde
