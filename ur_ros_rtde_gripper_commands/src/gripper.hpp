#pragma once

#include <string>
#include <ur_ros_rtde/check.hpp>
#include <ur_ros_rtde/outcome.hpp>
#include <ur_ros_rtde_robot/script/script_extension.hpp>
#include <utility>

namespace ur_ros_rtde_gripper_commands {

// Range of the largest fingers: "OnRobot Soft Gripper, user guide".
constexpr double min_width = 0.011;  // m
constexpr double max_width = 0.075;  // m
constexpr int max_tool_index = 3;
constexpr double millimeters_per_meter = 1000.0;  // the functions of the URCap take millimeters

inline ur_ros_rtde::ScriptExtension make_extension(std::string snippet)
{
  return {.snippet = std::move(snippet),
          .urcap = "the OnRobot URCap",
          .urcap_functions = {"get_sg_Width", "sg_grip", "sg_release"}};
}

inline void check_tool_index(ur_ros_rtde::Check & check, int index)
{
  check.in_range("tool_index", index, 0, max_tool_index);
}

/// Checks the fields that goals of sg_grip and sg_release have in common.
template <typename Goal>
void check_motion(ur_ros_rtde::Check & check, const Goal & goal)
{
  check.in_range("target_width", goal.target_width, min_width, max_width, "m");
  check_tool_index(check, goal.tool_index);
  check.above_zero("timeout", goal.timeout, 60.0, "s");
}

/// Runs the snippet, which writes the width to output register 19, and sets the width in the result. After a
/// failure, the register may have the value of another goal. The functions of the URCap return -1 if they do
/// not reach the gripper (OnRobot's user manual, on_return).
template <typename Run>
ur_ros_rtde::Outcome trigger_and_read_width(Run & run, double timeout)
{
  if (auto outcome = run.trigger(timeout); !outcome) {
    return outcome;
  }
  const double width = run.registers().get_double(19) / millimeters_per_meter;
  if (width < 0.0) {
    return ur_ros_rtde::Outcome::failure(
        ur_ros_rtde::ErrorCode::rejected_by_robot,
        "the gripper does not answer: check its power, its cable and the state of the OnRobot URCap");
  }
  run.result().width = width;
  return ur_ros_rtde::Outcome::success();
}

}  // namespace ur_ros_rtde_gripper_commands
