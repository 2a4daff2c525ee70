#include "primary/robot_state.hpp"

#include <cmath>

#include "kinematics/inverse.hpp"
#include "primary/big_endian.hpp"

namespace ur_simulator::primary {
namespace {

constexpr std::uint8_t robot_state = 16;

enum class Package : std::uint8_t {
  robot_mode = 0,
  joints = 1,
  tool = 2,
  masterboard = 3,
  cartesian = 4,
  kinematics = 5,
  configuration = 6,
  force_mode = 7,
  additional = 8,
};

// Of a healthy robot; nothing here changes them.
constexpr float supply_voltage = 48.0F;
constexpr float idle_current = 0.6F;
constexpr float board_temperature = 25.0F;
constexpr std::uint8_t running_tool = 253;

template <typename Derived>
void put(std::string & to, const Eigen::MatrixBase<Derived> & values)
{
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    put_f64(to, static_cast<double>(values[i]));
  }
}

bool powered(const ControllerState & s)
{
  return (s.robot_status_bits & 1U) != 0;
}

bool playing(const ControllerState & s)
{
  return s.runtime_state == RuntimeState::playing || s.runtime_state == RuntimeState::resuming;
}

bool paused(const ControllerState & s)
{
  return s.runtime_state == RuntimeState::paused || s.runtime_state == RuntimeState::pausing;
}

void add(std::string & message, Package type, const std::string & content)
{
  put_u32(message, static_cast<std::uint32_t>(content.size() + 5));
  put_u8(message, static_cast<std::uint8_t>(type));
  message += content;
}

std::string robot_mode_data(const ControllerState & s)
{
  constexpr std::uint8_t position_control = 0;
  constexpr std::uint8_t teach_control = 1;
  constexpr std::uint8_t force_control = 2;
  std::string data;
  put_u64(data, static_cast<std::uint64_t>(s.timestamp * 1e6));
  put_u8(data, 1);  // real robot connected
  put_u8(data, 1);  // real robot enabled
  put_u8(data, powered(s) ? 1 : 0);
  put_u8(data, s.safety_mode == SafetyMode::robot_emergency_stop ||
                       s.safety_mode == SafetyMode::system_emergency_stop
                   ? 1
                   : 0);
  put_u8(data, s.safety_mode == SafetyMode::protective_stop ? 1 : 0);
  put_u8(data, playing(s) ? 1 : 0);
  put_u8(data, paused(s) ? 1 : 0);
  put_u8(data, static_cast<std::uint8_t>(s.robot_mode));
  put_u8(data, s.freedrive ? teach_control : s.in_force_mode ? force_control : position_control);
  put_f64(data, s.target_speed_fraction);
  put_f64(data, s.speed_scaling);
  put_f64(data, 1.0);  // the highest target speed fraction
  put_u8(data, 0);
  return data;
}

std::string joint_data(const ControllerState & s)
{
  std::string data;
  for (Eigen::Index i = 0; i < 6; ++i) {
    put_f64(data, s.actual.position[i]);
    put_f64(data, s.target.position[i]);
    put_f64(data, s.actual.velocity[i]);
    put_f32(data, static_cast<float>(s.actual.current[i]));
    put_f32(data, powered(s) ? supply_voltage : 0.0F);
    put_f32(data, static_cast<float>(s.joint_temperatures[i]));
    put_f32(data, 0.0F);  // deprecated
    put_u8(data, static_cast<std::uint8_t>(s.joint_modes[static_cast<std::size_t>(i)]));
  }
  return data;
}

std::string tool_data(const ControllerState & s)
{
  std::string data;
  put_u8(data, s.io.tool_analog_input_types & 1U);
  put_u8(data, (s.io.tool_analog_input_types >> 1) & 1U);
  put_f64(data, s.io.tool_analog_inputs[0]);
  put_f64(data, s.io.tool_analog_inputs[1]);
  put_f32(data, powered(s) ? supply_voltage : 0.0F);
  put_u8(data, static_cast<std::uint8_t>(s.io.tool_output_voltage));
  put_f32(data, static_cast<float>(s.io.tool_output_current));
  put_f32(data, static_cast<float>(s.io.tool_temperature));
  put_u8(data, running_tool);
  return data;
}

std::string masterboard_data(const ControllerState & s)
{
  std::string data;
  put_u32(data, static_cast<std::uint32_t>(s.io.digital_inputs));
  put_u32(data, static_cast<std::uint32_t>(s.io.digital_outputs));
  put_u8(data, s.io.analog_io_types & 1U);
  put_u8(data, (s.io.analog_io_types >> 1) & 1U);
  put_f64(data, s.io.analog_inputs[0]);
  put_f64(data, s.io.analog_inputs[1]);
  put_u8(data, (s.io.analog_io_types >> 2) & 1U);
  put_u8(data, (s.io.analog_io_types >> 3) & 1U);
  put_f64(data, s.io.analog_outputs[0]);
  put_f64(data, s.io.analog_outputs[1]);
  put_f32(data, board_temperature);
  put_f32(data, powered(s) ? supply_voltage : 0.0F);
  put_f32(data, powered(s) ? idle_current : 0.0F);
  put_f32(data, 0.0F);  // current of the inputs and outputs
  put_u8(data, static_cast<std::uint8_t>(s.safety_mode));
  put_u8(data, s.safety_mode == SafetyMode::reduced ? 1 : 0);
  put_u8(data, 0);   // no Euromap interface
  put_u32(data, 0);  // internal
  put_u8(data, 0);   // operational mode selector: not wired
  put_u8(data, 0);   // three-position switch: not wired
  put_u8(data, 0);   // internal
  return data;
}

std::string cartesian_data(const ControllerState & s)
{
  std::string data;
  put(data, s.actual_tcp_pose);
  put(data, s.tcp_offset);
  return data;
}

std::string kinematics_data(const RobotModel & model)
{
  constexpr std::uint32_t no_checksum = 0xffffffff;
  constexpr std::uint32_t nominal = 0;  // calibration status: the model's own parameters
  std::string data;
  for (int i = 0; i < 6; ++i) {
    put_u32(data, no_checksum);
  }
  put(data, Vector6(Vector6::Zero()));
  put(data, model.a);
  put(data, model.d);
  put(data, model.alpha);
  put_u32(data, nominal);
  return data;
}

std::string configuration_data(const RobotModel & model)
{
  std::string data;
  for (Eigen::Index i = 0; i < 6; ++i) {
    put_f64(data, model.position_min[i]);
    put_f64(data, model.position_max[i]);
  }
  for (Eigen::Index i = 0; i < 6; ++i) {
    put_f64(data, model.velocity_max[i]);
    put_f64(data, model.acceleration_max[i]);
  }
  put_f64(data, 1.05);  // defaults of movej and movel
  put_f64(data, 1.4);
  put_f64(data, 0.25);
  put_f64(data, 1.2);
  put_f64(data, 0.25);  // equivalent radius
  put(data, model.a);
  put(data, model.d);
  put(data, model.alpha);
  put(data, Vector6(Vector6::Zero()));
  put_u32(data, 1);  // masterboard version
  put_u32(data, 1);  // controller box
  put_u32(data, model.type_number);
  put_u32(data, model.series == Series::cb3 ? 1 : 2);  // robot sub type
  return data;
}

std::string force_mode_data(const RobotModel & model, const ControllerState & s)
{
  std::string data;
  put(data, s.actual_tcp_force);
  put_f64(data, dexterity(model, s.actual.position));
  return data;
}

std::string additional_data(const ControllerState & s)
{
  std::string data;
  put_u8(data, s.freedrive ? 1 : 0);
  put_u8(data, 1);  // the freedrive button is enabled
  put_u8(data, 0);  // freedrive by an input is not
  put_u8(data, 0);
  return data;
}

}  // namespace

std::string robot_state_message(const RobotModel & model, const ControllerState & state)
{
  std::string packages;
  add(packages, Package::robot_mode, robot_mode_data(state));
  add(packages, Package::joints, joint_data(state));
  add(packages, Package::tool, tool_data(state));
  add(packages, Package::masterboard, masterboard_data(state));
  add(packages, Package::cartesian, cartesian_data(state));
  add(packages, Package::kinematics, kinematics_data(model));
  add(packages, Package::configuration, configuration_data(model));
  add(packages, Package::force_mode, force_mode_data(model, state));
  add(packages, Package::additional, additional_data(state));
  std::string message;
  put_u32(message, static_cast<std::uint32_t>(packages.size() + 5));
  put_u8(message, robot_state);
  return message + packages;
}

}  // namespace ur_simulator::primary
