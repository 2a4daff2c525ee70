#include "primary/robot_state.hpp"

#include <cmath>

#include "common/big_endian.hpp"
#include "kinematics/inverse_kinematics.hpp"
#include "state/electrical_constants.hpp"

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
  tool_communication = 11,
  tool_mode = 12,
};

// Constant values of an operational robot.
constexpr auto supply_voltage = static_cast<float>(main_voltage);
constexpr auto idle_current = static_cast<float>(idle_robot_current);
constexpr float board_temperature = 25.0F;
constexpr std::uint8_t tool_mode_running = 253;

template <typename Derived>
void put(std::string & to, const Eigen::MatrixBase<Derived> & values)
{
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    put_f64(to, static_cast<double>(values[i]));
  }
}

bool playing(const ControllerState & s)
{
  return s.runtime_state == RuntimeState::playing || s.runtime_state == RuntimeState::resuming;
}

bool paused(const ControllerState & s)
{
  return s.runtime_state == RuntimeState::paused || s.runtime_state == RuntimeState::pausing;
}

void append_package(std::string & message, Package type, const std::string & content)
{
  put_u32(message, static_cast<std::uint32_t>(content.size() + 5));
  put_u8(message, static_cast<std::uint8_t>(type));
  message += content;
}

/// First version of each controller generation with certain fields.
constexpr MinVersion cb3_since(std::uint32_t minor)
{
  return {MinVersion::always, {3, minor, 0, 0}};
}

std::string robot_mode_data(const PolyscopeVersion & version, const ControllerState & s)
{
  constexpr std::uint8_t position_control = 0;
  constexpr std::uint8_t teach_control = 1;
  constexpr std::uint8_t force_control = 2;
  std::string data;
  put_u64(data, static_cast<std::uint64_t>(s.timestamp * 1e6));
  put_u8(data, 1);  // real robot connected
  put_u8(data, 1);  // real robot enabled
  put_u8(data, s.is_powered() ? 1 : 0);
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
  put_f64(data, s.reported_speed_scaling());
  if (cb3_since(2).is_met_by(version)) {
    put_f64(data, 1.0);  // limit of the target speed fraction
  }
  if (cb3_since(5).is_met_by(version)) {
    put_u8(data, 0);  // internal
  }
  return data;
}

std::string joint_data(const ControllerState & s)
{
  std::string data;
  for (Eigen::Index i = 0; i < 6; ++i) {
    put_f64(data, s.measured.position[i]);
    put_f64(data, s.target.position[i]);
    put_f64(data, s.actual.velocity[i]);
    put_f32(data, static_cast<float>(s.measured.current[i]));
    put_f32(data, s.is_powered() ? supply_voltage : 0.0F);
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
  put_f32(data, s.is_powered() ? supply_voltage : 0.0F);
  put_u8(data, static_cast<std::uint8_t>(s.io.tool_output_voltage));
  put_f32(data, static_cast<float>(s.io.tool_output_current));
  put_f32(data, static_cast<float>(s.io.tool_temperature));
  put_u8(data, tool_mode_running);
  return data;
}

std::string masterboard_data(const PolyscopeVersion & version, const ControllerState & s)
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
  put_f32(data, s.is_powered() ? supply_voltage : 0.0F);
  put_f32(data, s.is_powered() ? idle_current : 0.0F);
  put_f32(data, 0.0F);  // current of the inputs and outputs
  put_u8(data, static_cast<std::uint8_t>(s.safety_mode));
  put_u8(data, s.safety_mode == SafetyMode::reduced ? 1 : 0);
  put_u8(data, 0);   // no Euromap interface
  put_u32(data, 0);  // internal
  if (cb3_since(2).is_met_by(version)) {
    put_u8(data, 0);  // operational mode selector: not wired
    put_u8(data, 0);  // three-position switch: not wired
  }
  if (cb3_since(10).is_met_by(version)) {
    put_u8(data, 0);  // internal
  }
  return data;
}

std::string cartesian_data(const ControllerState & s)
{
  std::string data;
  put(data, s.measured.tcp_pose);
  put(data, s.tcp_offset);
  return data;
}

/// A robot identifies the calibration of each joint by a checksum. Its algorithm is not published: this is
/// the FNV-1a hash of the parameters.
std::uint32_t kinematics_checksum(const RobotModel & model, Eigen::Index joint)
{
  constexpr std::uint32_t no_checksum = 0xffffffff;
  if (!model.calibrated) {
    return no_checksum;
  }
  std::string row;
  for (const Vector6 * values : {&model.theta, &model.a, &model.d, &model.alpha}) {
    put_f64(row, (*values)[joint]);
  }
  std::uint32_t hash = 2166136261U;
  for (const char byte : row) {
    hash = (hash ^ static_cast<std::uint8_t>(byte)) * 16777619U;
  }
  return hash;
}

std::string kinematics_data(const RobotModel & model)
{
  // An example of the Universal Robots Client Library and the packages in its tests: 2 is a calibrated arm
  // ("linearized"), 0 is that of UR's simulator.
  const std::uint32_t calibration_status = model.calibrated ? 2 : 0;
  std::string data;
  for (Eigen::Index i = 0; i < 6; ++i) {
    put_u32(data, kinematics_checksum(model, i));
  }
  put(data, model.theta);
  put(data, model.a);
  put(data, model.d);
  put(data, model.alpha);
  put_u32(data, calibration_status);
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
  put_f64(data, 1.05);  // default joint velocity, rad/s
  put_f64(data, 1.4);   // default joint acceleration, rad/s^2
  put_f64(data, 0.25);  // default tool velocity, m/s
  put_f64(data, 1.2);   // default tool acceleration, m/s^2
  put_f64(data, 0.25);  // equivalent radius, m
  put(data, model.a);
  put(data, model.d);
  put(data, model.alpha);
  put(data, model.theta);
  put_u32(data, 1);  // masterboard version
  put_u32(data, 1);  // controller box
  put_u32(data, model.type_number);
  put_u32(data, model.series == Series::cb3 ? 1 : 2);  // robot sub type
  return data;
}

std::string force_mode_data(const RobotModel & model, const ControllerState & s)
{
  std::string data;
  put(data, s.reported_tcp_force);
  put_f64(data, singularity_distance(model, s.actual.position));
  return data;
}

std::string tool_communication_data(const ToolCommunication & line)
{
  std::string data;
  put_u8(data, line.enabled ? 1 : 0);
  put_u32(data, static_cast<std::uint32_t>(line.baud_rate));
  put_u32(data, static_cast<std::uint32_t>(line.parity));
  put_u32(data, static_cast<std::uint32_t>(line.stop_bits));
  put_f32(data, static_cast<float>(line.rx_idle_chars));
  put_f32(data, static_cast<float>(line.tx_idle_chars));
  return data;
}

std::string tool_mode_data(const Io & io)
{
  std::string data;
  put_u8(data, static_cast<std::uint8_t>(io.tool_output_mode));
  for (const std::int32_t mode : io.tool_digital_output_modes) {
    put_u8(data, static_cast<std::uint8_t>(mode));
  }
  return data;
}

std::string additional_data(const ControllerState & s)
{
  std::string data;
  put_u8(data, s.freedrive ? 1 : 0);
  put_u8(data, 1);  // freedrive button enabled
  put_u8(data, 0);  // freedrive by IO disabled
  put_u8(data, 0);
  return data;
}

}  // namespace

std::string robot_state_message(const RobotModel & model, const PolyscopeVersion & version,
                                const ControllerState & state)
{
  std::string packages;
  append_package(packages, Package::robot_mode, robot_mode_data(version, state));
  append_package(packages, Package::joints, joint_data(state));
  append_package(packages, Package::tool, tool_data(state));
  append_package(packages, Package::masterboard, masterboard_data(version, state));
  append_package(packages, Package::cartesian, cartesian_data(state));
  append_package(packages, Package::kinematics, kinematics_data(model));
  append_package(packages, Package::configuration, configuration_data(model));
  append_package(packages, Package::force_mode, force_mode_data(model, state));
  append_package(packages, Package::additional, additional_data(state));
  if (version.is_e_series()) {
    append_package(packages, Package::tool_communication,
                   tool_communication_data(state.io.tool_communication));
    append_package(packages, Package::tool_mode, tool_mode_data(state.io));
  }
  std::string message;
  put_u32(message, static_cast<std::uint32_t>(packages.size() + 5));
  put_u8(message, robot_state);
  return message + packages;
}

}  // namespace ur_simulator::primary
