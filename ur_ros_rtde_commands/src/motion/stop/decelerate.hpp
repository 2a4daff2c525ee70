#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <ur_ros_rtde_msgs/action/decelerate.hpp>
#include <vector>

#include "motion/speed_limits.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

/// Waits for the stop that the goal has begun. Sets `time_to_standstill` of the result; the message names the
/// preempted goal, and what stopped the arm.
template <typename Run>
Outcome wait_until_stopped(Run & run)
{
  const auto report = run.wait_for_stop();
  if (!report) {
    return report.error();
  }
  run.result().time_to_standstill = report->time_to_standstill;
  const char * means = to_string(report->means);
  return Outcome::success(
      run.preempted_goal().empty() ? means : fmt::format("{} was stopped ({})", run.preempted_goal(), means));
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

  Outcome run(const Goal &, Run & run) override { return wait_until_stopped(run); }

  std::vector<Kind> kinds_;
  double max_;
  std::string unit_;
};

}  // namespace ur_ros_rtde
