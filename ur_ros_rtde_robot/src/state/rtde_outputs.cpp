#include "ur_ros_rtde_robot/state/rtde_outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace ur_ros_rtde {
namespace {

constexpr std::array single{
    "timestamp",
    "target_q",
    "target_qd",
    "target_qdd",
    "target_current",
    "target_moment",
    "actual_q",
    "actual_qd",
    "actual_qdd",
    "actual_current",
    "actual_current_window",
    "actual_current_as_torque",
    "actual_moment",
    "joint_control_output",
    "joint_temperatures",
    "joint_mode",
    "joint_position_deviation_ratio",
    "actual_joint_voltage",
    "actual_TCP_pose",
    "actual_TCP_speed",
    "actual_TCP_force",
    "target_TCP_pose",
    "target_TCP_speed",
    "tcp_offset",
    "tcp_force_scalar",
    "ft_raw_wrench",
    "actual_tool_accelerometer",
    "elbow_position",
    "elbow_velocity",
    "payload",
    "payload_cog",
    "payload_inertia",
    "actual_momentum",
    "collision_detection_ratio",
    "robot_mode",
    "safety_mode",
    "safety_status",
    "runtime_state",
    "robot_status_bits",
    "safety_status_bits",
    "speed_scaling",
    "target_speed_fraction",
    "time_scale_source",
    "script_control_line",
    "actual_execution_time",
    "actual_main_voltage",
    "actual_robot_voltage",
    "actual_robot_current",
    "actual_robot_energy_consumed",
    "actual_robot_braking_energy_dissipated",
    "io_current",
    "actual_digital_input_bits",
    "actual_digital_output_bits",
    "analog_io_types",
    "standard_analog_input0",
    "standard_analog_input1",
    "standard_analog_output0",
    "standard_analog_output1",
    "tool_mode",
    "tool_output_mode",
    "tool_output_voltage",
    "tool_output_current",
    "tool_temperature",
    "tool_analog_input_types",
    "tool_analog_input0",
    "tool_analog_input1",
    "tool_digital_output0_mode",
    "tool_digital_output1_mode",
    "euromap67_input_bits",
    "euromap67_output_bits",
    "euromap67_24V_voltage",
    "euromap67_24V_current",
    "encoder0_raw",
    "encoder1_raw",
    "input_bit_registers0_to_31",
    "input_bit_registers32_to_63",
    "output_bit_registers0_to_31",
    "output_bit_registers32_to_63",
};

struct Numbered {
  std::string_view stem;
  unsigned first;
  unsigned last;
};
constexpr std::array numbered{
    Numbered{"input_bit_register_", 64, 127},  Numbered{"output_bit_register_", 64, 127},
    Numbered{"input_int_register_", 0, 47},    Numbered{"output_int_register_", 0, 47},
    Numbered{"input_double_register_", 0, 47}, Numbered{"output_double_register_", 0, 47},
};

bool matches(const Numbered & field, std::string_view name)
{
  if (!name.starts_with(field.stem)) {
    return false;
  }
  const std::string_view digits = name.substr(field.stem.size());
  unsigned number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return error == std::errc() && end == digits.data() + digits.size() && number >= field.first &&
         number <= field.last && digits == std::to_string(number);
}

}  // namespace

bool is_rtde_output(std::string_view name)
{
  return std::ranges::find(single, name) != single.end() ||
         std::ranges::any_of(numbered, [&](const Numbered & field) { return matches(field, name); });
}

Status check_rtde_outputs(const std::vector<std::string> & names)
{
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (!is_rtde_output(*name)) {
      return failure(
          ErrorCode::invalid_goal,
          fmt::format("\"{}\" is not an RTDE output: the names are those of the table \"Robot controller "
                      "outputs\" in UR's \"Real-Time Data Exchange (RTDE) Guide\"",
                      *name));
    }
    if (std::find(names.begin(), name, *name) != name) {
      return failure(ErrorCode::invalid_goal, fmt::format("\"{}\" occurs twice", *name));
    }
  }
  return {};
}

}  // namespace ur_ros_rtde
