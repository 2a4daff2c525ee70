#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <ur_ros_rtde_msgs/action/decelerate.hpp>
#include <vector>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

/// What a command that takes over has to do once nobody else moves the arm: stops what still moves, and says
/// who was stopped. `Run` has a result with `time_to_standstill`.
template <typename Run>
Outcome decelerate(Run & run, const StopOptions & options)
{
  const auto report = run.robot().stop_motion(options);
  if (!report) {
    return report.error();
  }
  run.result().time_to_standstill = std::chrono::duration<double>(run.elapsed()).count();
  return Outcome::success(run.preempted_goal().empty() ? to_string(report->means)
                                                       : run.preempted_goal() + " was stopped");
}

/// The stop of one kind of motion: `deceleration` is that of the kinds it names, any other motion is stopped
/// with the default.
class DecelerateCommand : public Command<ur_ros_rtde_msgs::action::Decelerate> {
 public:
  using Kind = double StopOptions::*;
  static constexpr double highest_joint_deceleration = 40.0;    // rad/s^2
  static constexpr double highest_linear_deceleration = 150.0;  // m/s^2

  DecelerateCommand(std::vector<Kind> kinds, double highest, std::string unit)
      : kinds_(std::move(kinds)), highest_(highest), unit_(std::move(unit))
  {
  }

 private:
  CommandTraits traits() const override { return {.preempts_all = true}; }

  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("deceleration", goal.deceleration, 0.1, highest_, unit_);
  }

  StopOptions stop_options(const Goal & goal) const override
  {
    StopOptions options;
    for (const Kind kind : kinds_) {
      options.*kind = goal.deceleration;
    }
    options.joint_deceleration = std::min(options.joint_deceleration, highest_joint_deceleration);
    return options;
  }

  Outcome run(const Goal & goal, Run & run) override { return decelerate(run, stop_options(goal)); }

  std::vector<Kind> kinds_;
  double highest_;
  std::string unit_;
};

}  // namespace ur_ros_rtde
