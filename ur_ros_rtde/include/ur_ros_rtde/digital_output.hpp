#pragma once

#include "ur_ros_rtde/outcome.hpp"
#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde {

/// The digital outputs of the controller: 0-7 standard, 8-15 configurable, 16-17 tool.
constexpr unsigned first_configurable_output = 8;
constexpr unsigned first_tool_output = 16;
constexpr unsigned digital_output_count = 18;

/// Sets digital output `number` and waits, at most 1 s, until the robot reports its new state.
[[nodiscard]] Outcome set_digital_output(Run & run, unsigned number, bool state);

}  // namespace ur_ros_rtde
