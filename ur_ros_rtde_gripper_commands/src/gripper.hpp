#pragma once

#include <string>
#include <ur_ros_rtde/check.hpp>
#include <ur_ros_rtde_robot/program/script_extension.hpp>
#include <utility>

namespace ur_ros_rtde_gripper_commands {

// "OnRobot Soft Gripper, user guide": what the largest fingers can do. The URCap's functions take
// millimetres.
constexpr double narrowest = 0.011;  // m
constexpr double widest = 0.075;     // m
constexpr int last_tool = 3;

inline ur_ros_rtde::ScriptExtension gripper_script(std::string snippet)
{
  return {.snippet = std::move(snippet),
          .urcap = "the OnRobot URCap",
          .urcap_functions = {"get_sg_Width", "sg_grip", "sg_release"}};
}

inline void check_width(ur_ros_rtde::Check & check, double width)
{
  check.in_range("target_width", width, narrowest, widest, "m");
}

inline void check_tool(ur_ros_rtde::Check & check, int index)
{
  check.in_range("tool_index", index, 0, last_tool);
}

}  // namespace ur_ros_rtde_gripper_commands
