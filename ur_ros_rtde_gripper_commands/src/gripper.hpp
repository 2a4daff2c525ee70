#pragma once

#include <cmath>
#include <string>
#include <ur_ros_rtde/check.hpp>
#include <ur_ros_rtde/outcome.hpp>
#include <ur_ros_rtde_robot/script/script_extension.hpp>
#include <utility>

namespace ur_ros_rtde_gripper_commands {

// Range of all fingers, 11 to 75 mm (SG-a) and 24 to 117 mm (SG-b).
constexpr double min_width = 0.011;               // m
constexpr double max_width = 0.117;               // m
constexpr double millimeters_per_meter = 1000.0;  // the functions of the URCap take integer millimeters

inline ur_ros_rtde::ScriptExtension make_extension(std::string snippet)
{
  return {.snippet = std::move(snippet),
          .urcap = "the OnRobot URCap",
          .urcap_functions = {"get_sg_Width", "sg_grip", "sg_release"}};
}

/// Checks the fields that goals of sg_grip and sg_release have in common.
template <typename Goal>
void check_motion(ur_ros_rtde::Check & check, const Goal & goal)
{
  check.in_range("target_width", goal.target_width, min_width, max_width, "m");
  check.above_zero("timeout", goal.timeout, 60.0, "s");
}

/// Runs the snippet, which writes the width to output register 19, and sets the width in the result. After a
/// failure, the register may have the value of another goal. If the URCap does not reach the gripper, or the
/// fingers do not have the width, it shows a popup and ends the program.
template <typename Run>
ur_ros_rtde::Outcome trigger_and_read_width(Run & run, double timeout)
{
  if (auto outcome = run.trigger(timeout); !outcome) {
    return outcome;
  }
  run.result().width = run.registers().get_double(19) / millimeters_per_meter;
  return ur_ros_rtde::Outcome::success();
}

template <typename Goal>
int target_in_millimeters(const Goal & goal)
{
  return static_cast<int>(std::lround(millimeters_per_meter * goal.target_width));
}

}  // namespace ur_ros_rtde_gripper_commands
