#include <fmt/format.h>

#include <algorithm>

#include "rtde/fields.hpp"
#include "state/electrical_constants.hpp"

namespace ur_simulator::rtde {
namespace {

using State = ControllerState;

constexpr PolyscopeVersion never = MinVersion::never;

/// Version from which the RTDE guide lists a field.
constexpr PolyscopeVersion v(std::uint32_t major, std::uint32_t minor, std::uint32_t bugfix = 0)
{
  return {major, minor, bugfix, 0};
}

constexpr double current_window = 5.0;         // A: allowed deviation from the target current
constexpr double target_execution_time = 1.0;  // ms

std::int32_t time_scale_source(const State & s)
{
  constexpr std::int32_t program_not_running = 0;
  const bool running = s.runtime_state == RuntimeState::playing || s.runtime_state == RuntimeState::resuming;
  return running ? static_cast<std::int32_t>(s.time_scale_source) : program_not_running;
}

/// The configurable ones of the digital inputs or outputs, as bits 0 to 7.
constexpr std::uint64_t configurable_bits(std::uint64_t digital_bits)
{
  return (digital_bits >> 8) & 0xff;
}

template <typename Bits>
std::uint32_t word(const Bits & bits, unsigned first)
{
  std::uint32_t value = 0;
  for (unsigned i = 0; i < 32; ++i) {
    value |= static_cast<std::uint32_t>(bits[first + i]) << i;
  }
  return value;
}

/// The function that encodes the value of a C++ expression; `s` is the state, `i` the number of the register.
#define UR_OUTPUT(expression)                                                             \
  []([[maybe_unused]] const State & s, [[maybe_unused]] unsigned i, PackageWriter & to) { \
    to.put(expression);                                                                   \
  }

void add_registers(std::vector<OutputField> & fields)
{
  const MinVersion input_readback_since{v(5, 0), v(3, 4)};
  const MinVersion upper_registers_since{v(5, 3), v(3, 9)};
  const auto add = [&fields](std::string name, FieldType type, MinVersion min_version, unsigned index,
                             auto write) {
    fields.push_back({std::move(name), type, min_version, index, write});
  };
  for (unsigned n = 0; n < 2; ++n) {
    const std::string range = fmt::format("{}_to_{}", 32 * n, 32 * n + 31);
    add("output_bit_registers" + range, FieldType::uint32, {}, n, UR_OUTPUT(word(s.outputs.bits, 32 * i)));
    add("input_bit_registers" + range, FieldType::uint32, input_readback_since, n,
        UR_OUTPUT(word(s.inputs.bits, 32 * i)));
  }
  for (unsigned n = 64; n < 128; ++n) {
    add(fmt::format("output_bit_register_{}", n), FieldType::boolean, upper_registers_since, n,
        UR_OUTPUT(s.outputs.bits.test(i)));
    add(fmt::format("input_bit_register_{}", n), FieldType::boolean, upper_registers_since, n,
        UR_OUTPUT(s.inputs.bits.test(i)));
  }
  for (unsigned n = 0; n < 48; ++n) {
    const MinVersion outputs = n < 24 ? MinVersion{} : upper_registers_since;
    const MinVersion inputs = n < 24 ? input_readback_since : upper_registers_since;
    add(fmt::format("output_int_register_{}", n), FieldType::int32, outputs, n,
        UR_OUTPUT(s.outputs.integers[i]));
    add(fmt::format("output_double_register_{}", n), FieldType::double_, outputs, n,
        UR_OUTPUT(double{s.outputs.floats[i]}));
    add(fmt::format("input_int_register_{}", n), FieldType::int32, inputs, n,
        UR_OUTPUT(s.inputs.integers[i]));
    add(fmt::format("input_double_register_{}", n), FieldType::double_, inputs, n,
        UR_OUTPUT(double{s.inputs.floats[i]}));
  }
}

void add_motion_outputs(std::vector<OutputField> & fields)
{
  using enum FieldType;
  const std::vector<OutputField> rows{
      {"timestamp", double_, {}, 0, UR_OUTPUT(s.timestamp)},
      {"target_q", vector6d, {}, 0, UR_OUTPUT(s.target.position)},
      {"target_qd", vector6d, {}, 0, UR_OUTPUT(s.target.velocity)},
      {"target_qdd", vector6d, {}, 0, UR_OUTPUT(s.target.acceleration)},
      {"target_current", vector6d, {}, 0, UR_OUTPUT(s.target.current)},
      {"target_moment", vector6d, {}, 0, UR_OUTPUT(s.target.torque)},
      {"actual_q", vector6d, {}, 0, UR_OUTPUT(s.measured.position)},
      {"actual_qd", vector6d, {}, 0, UR_OUTPUT(s.actual.velocity)},
      {"actual_current", vector6d, {}, 0, UR_OUTPUT(s.measured.current)},
      {"actual_current_window", vector6d, {}, 0, UR_OUTPUT(Vector6(Vector6::Constant(current_window)))},
      {"actual_current_as_torque", vector6d, {v(5, 23), never}, 0, UR_OUTPUT(s.actual.torque)},
      {"joint_control_output", vector6d, {}, 0, UR_OUTPUT(s.target.current)},
      {"joint_temperatures", vector6d, {}, 0, UR_OUTPUT(s.joint_temperatures)},
      {"joint_position_deviation_ratio", double_, {v(5, 14), never}, 0, UR_OUTPUT(s.joint_deviation_ratio)},
      {"collision_detection_ratio", double_, {v(5, 15), never}, 0, UR_OUTPUT(s.collision_force_ratio)},
      {"speed_scaling", double_, {}, 0, UR_OUTPUT(s.reported_speed_scaling())},
      {"target_speed_fraction", double_, {}, 0, UR_OUTPUT(s.target_speed_fraction)},
      {"time_scale_source", int32, {v(5, 17), never}, 0, UR_OUTPUT(time_scale_source(s))},
  };
  fields.insert(fields.end(), rows.begin(), rows.end());
}

void add_tcp_and_payload_outputs(std::vector<OutputField> & fields)
{
  using enum FieldType;
  const std::vector<OutputField> rows{
      {"actual_TCP_pose", vector6d, {}, 0, UR_OUTPUT(s.measured.tcp_pose)},
      {"actual_TCP_speed", vector6d, {}, 0, UR_OUTPUT(s.actual_tcp_speed)},
      {"actual_TCP_force", vector6d, {}, 0, UR_OUTPUT(s.reported_tcp_force)},
      {"target_TCP_pose", vector6d, {}, 0, UR_OUTPUT(s.target_tcp_pose)},
      {"target_TCP_speed", vector6d, {}, 0, UR_OUTPUT(s.target_tcp_speed)},
      {"actual_TCP_acceleration", vector6d, {v(5, 23), never}, 0, UR_OUTPUT(s.actual_tcp_acceleration)},
      {"target_TCP_acceleration", vector6d, {v(5, 23), never}, 0, UR_OUTPUT(s.target_tcp_acceleration)},
      {"elbow_position", vector3d, {v(5, 0), v(3, 5)}, 0, UR_OUTPUT(s.elbow_position)},
      {"elbow_velocity", vector3d, {v(5, 0), v(3, 5)}, 0, UR_OUTPUT(s.elbow_velocity)},
      {"tcp_offset", vector6d, {v(5, 5, 1), v(3, 12)}, 0, UR_OUTPUT(s.tcp_offset)},
      {"tcp_force_scalar", double_, {}, 0, UR_OUTPUT(s.actual_tcp_force.head<3>().norm())},
      {"ft_raw_wrench", vector6d, {v(5, 9), never}, 0, UR_OUTPUT(s.ft_raw_wrench)},
      // The disturbance of the motion control is what the joint currents reveal.
      {"wrench_calc_from_currents", vector6d, {v(5, 23), never}, 0, UR_OUTPUT(s.tool_wrench)},
      {"target_gravity", vector3d, {v(5, 26), never}, 0, UR_OUTPUT(s.gravity)},
      {"target_base_acceleration", vector6d, {v(5, 26), never}, 0, UR_OUTPUT(Vector6(Vector6::Zero()))},
      {"target_base_wrench", vector6d, {v(5, 26), never}, 0, UR_OUTPUT(s.target_base_wrench)},
      {"payload", double_, {v(5, 5, 1), v(3, 11)}, 0, UR_OUTPUT(s.payload.mass)},
      {"payload_cog", vector3d, {v(5, 5, 1), v(3, 11)}, 0, UR_OUTPUT(s.payload.center_of_gravity)},
      {"payload_inertia", vector6d, {v(5, 11), v(3, 15)}, 0, UR_OUTPUT(s.payload.inertia)},
      {"actual_tool_accelerometer", vector3d, {}, 0, UR_OUTPUT(s.measured.tool_acceleration)},
      {"actual_momentum", double_, {}, 0, UR_OUTPUT(s.payload.mass * s.actual_tcp_speed.head<3>().norm())},
  };
  fields.insert(fields.end(), rows.begin(), rows.end());
}

void write_joint_modes(const State & s, unsigned, PackageWriter & to)
{
  for (const std::int32_t mode : s.joint_modes) {
    to.put(mode);
  }
}

void add_mode_outputs(std::vector<OutputField> & fields)
{
  using enum FieldType;
  const std::vector<OutputField> rows{
      {"robot_mode", int32, {}, 0, UR_OUTPUT(static_cast<std::int32_t>(s.robot_mode))},
      {"joint_mode", vector6int32, {}, 0, write_joint_modes},
      {"safety_mode", int32, {}, 0, UR_OUTPUT(static_cast<std::int32_t>(s.safety_mode))},
      {"safety_status", int32, {v(5, 4), v(3, 10)}, 0, UR_OUTPUT(static_cast<std::int32_t>(s.safety_mode))},
      {"runtime_state", uint32, {}, 0, UR_OUTPUT(static_cast<std::uint32_t>(s.runtime_state))},
      {"robot_status_bits", uint32, {}, 0, UR_OUTPUT(s.robot_status_bits)},
      {"safety_status_bits", uint32, {}, 0, UR_OUTPUT(s.safety_status_bits)},
      {"actual_execution_time", double_, {}, 0, UR_OUTPUT(s.actual_execution_time)},
      {"target_execution_time", double_, {v(5, 23), never}, 0, UR_OUTPUT(target_execution_time)},
      {"control_step", uint64, {v(5, 26), never}, 0, UR_OUTPUT(s.cycle)},
      {"script_control_line", uint32, {v(5, 9), v(3, 14)}, 0, UR_OUTPUT(std::uint32_t{0})},
  };
  fields.insert(fields.end(), rows.begin(), rows.end());
}

void add_io_outputs(std::vector<OutputField> & fields)
{
  using enum FieldType;
  const std::vector<OutputField> rows{
      {"actual_digital_input_bits", uint64, {}, 0, UR_OUTPUT(s.io.digital_inputs)},
      {"actual_digital_output_bits", uint64, {}, 0, UR_OUTPUT(s.io.digital_outputs)},
      {"actual_configurable_digital_input_bits",
       uint64,
       {v(5, 23), never},
       0,
       UR_OUTPUT(configurable_bits(s.io.digital_inputs))},
      {"actual_configurable_digital_output_bits",
       uint64,
       {v(5, 23), never},
       0,
       UR_OUTPUT(configurable_bits(s.io.digital_outputs))},
      {"analog_io_types", uint32, {}, 0, UR_OUTPUT(s.io.analog_io_types)},
      {"standard_analog_input0", double_, {}, 0, UR_OUTPUT(s.io.analog_inputs[0])},
      {"standard_analog_input1", double_, {}, 0, UR_OUTPUT(s.io.analog_inputs[1])},
      {"standard_analog_output0", double_, {}, 0, UR_OUTPUT(s.io.analog_outputs[0])},
      {"standard_analog_output1", double_, {}, 0, UR_OUTPUT(s.io.analog_outputs[1])},
      {"io_current", double_, {}, 0, UR_OUTPUT(0.0)},
      {"tool_mode", uint32, {}, 0, UR_OUTPUT(static_cast<std::uint32_t>(s.is_powered() ? 253 : 239))},
      {"tool_analog_input_types", uint32, {}, 0, UR_OUTPUT(s.io.tool_analog_input_types)},
      {"tool_analog_input0", double_, {}, 0, UR_OUTPUT(s.io.tool_analog_inputs[0])},
      {"tool_analog_input1", double_, {}, 0, UR_OUTPUT(s.io.tool_analog_inputs[1])},
      {"tool_output_voltage", int32, {}, 0, UR_OUTPUT(s.io.tool_output_voltage)},
      {"tool_output_current", double_, {}, 0, UR_OUTPUT(s.io.tool_output_current)},
      {"tool_temperature", double_, {}, 0, UR_OUTPUT(s.io.tool_temperature)},
      {"tool_output_mode",
       uint8,
       {v(5, 0), never},
       0,
       UR_OUTPUT(static_cast<std::uint8_t>(s.io.tool_output_mode))},
      {"tool_digital_output0_mode",
       uint8,
       {v(5, 0), never},
       0,
       UR_OUTPUT(static_cast<std::uint8_t>(s.io.tool_digital_output_modes[0]))},
      {"tool_digital_output1_mode",
       uint8,
       {v(5, 0), never},
       0,
       UR_OUTPUT(static_cast<std::uint8_t>(s.io.tool_digital_output_modes[1]))},
      {"euromap67_input_bits", uint32, {}, 0, UR_OUTPUT(std::uint32_t{0})},
      {"euromap67_output_bits", uint32, {}, 0, UR_OUTPUT(std::uint32_t{0})},
      {"euromap67_24V_voltage", double_, {}, 0, UR_OUTPUT(0.0)},
      {"euromap67_24V_current", double_, {}, 0, UR_OUTPUT(0.0)},
      {"encoder0_raw", int32, {v(5, 23), never}, 0, UR_OUTPUT(std::int32_t{0})},  // no encoders
      {"encoder1_raw", int32, {v(5, 23), never}, 0, UR_OUTPUT(std::int32_t{0})},
      {"actual_main_voltage", double_, {}, 0, UR_OUTPUT(main_voltage)},
      {"actual_robot_voltage", double_, {}, 0, UR_OUTPUT(s.is_powered() ? main_voltage : 0.0)},
      {"actual_robot_current", double_, {}, 0, UR_OUTPUT(s.is_powered() ? idle_robot_current : 0.0)},
      {"actual_robot_energy_consumed", double_, {v(5, 23), never}, 0, UR_OUTPUT(s.energy.consumed)},
      {"actual_robot_braking_energy_dissipated",
       double_,
       {v(5, 23), never},
       0,
       UR_OUTPUT(s.energy.braking_dissipated)},
      {"actual_joint_voltage",
       vector6d,
       {},
       0,
       UR_OUTPUT(Vector6::Constant(s.is_powered() ? main_voltage : 0.0))},
  };
  fields.insert(fields.end(), rows.begin(), rows.end());
}

#undef UR_OUTPUT

}  // namespace

const std::vector<OutputField> & output_fields()
{
  static const std::vector<OutputField> fields = [] {
    std::vector<OutputField> all;
    add_motion_outputs(all);
    add_tcp_and_payload_outputs(all);
    add_mode_outputs(all);
    add_io_outputs(all);
    add_registers(all);
    std::ranges::sort(all, {}, &OutputField::name);
    return all;
  }();
  return fields;
}

}  // namespace ur_simulator::rtde
