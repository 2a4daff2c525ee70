#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <ur_ros_rtde_msgs/action/decelerate.hpp>
#include <vector>

#include "motion/speed_limits.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

/// Stops the arm for a command that preempts all other goals. Sets `time_to_standstill` of the result; the
/// message names the preempted goal.
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

/// Stops all motion. The field `deceleration` of the goal applies to the given kinds of motion; other motion
/// is stopped with the default deceleration.
class DecelerateCommand : public Command<ur_ros_rtde_msgs::action::Decelerate> {
 public:
  using Kind = double StopOptions::*;

  DecelerateCommand(std::vector<Kind> kinds, double max, std::string unit)
      : kinds_(std::move(kinds)), max_(max), unit_(std::move(unit))
  {
  }

 private:
  CommandTraits traits() const override { return {.preempts_all = true}; }

  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("deceleration", goal.deceleration, min_deceleration, max_, unit_);
  }

  StopOptions stop_options(const Goal & goal) const override
  {
    StopOptions options;
    for (const Kind kind : kinds_) {
      options.*kind = goal.deceleration;
    }
    options.joint_deceleration = std::min(options.joint_deceleration, max_joint_deceleration);
    return options;
  }

  Outcome run(const Goal & goal, Run & run) override { return decelerate(run, stop_options(goal)); }

  std::vector<Kind> kinds_;
  double max_;
  std::string unit_;
};

}  // namespace ur_ros_rtde
