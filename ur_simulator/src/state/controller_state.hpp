#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <string>

#include "common/types.hpp"
#include "state/modes.hpp"

namespace ur_simulator {

/// The general purpose registers with which RTDE clients and the robot program exchange data. Sizes of
/// PolyScope 5 (UR, "RTDE Guide"). RTDE transfers the floats as doubles; the controller keeps 32 bits of
/// them: 556.044 comes back as 556.04400634765625 (UR's forum, topic 7623).
struct Registers {
  std::bitset<128> bits;
  std::array<std::int32_t, 48> integers{};
  std::array<float, 48> floats{};
};

/// The registers that exist for MODBUS clients and port functions of programs alone.
struct PortRegisters {
  std::array<std::uint16_t, 128> general_purpose{};
  double split_time = 0.0;  ///< s since start, stored by the last write to the split time register
};

/// The serial line (RS485) in the tool connector, as set_tool_communication() configures it.
struct ToolCommunication {
  bool enabled = false;
  std::int32_t baud_rate = 115200;
  std::int32_t parity = 0;  ///< 0 none, 1 odd, 2 even
  std::int32_t stop_bits = 1;
  double rx_idle_chars = 1.5;  ///< silence that ends a message, in characters
  double tx_idle_chars = 3.5;  ///< silence before a message, in characters
};

/// Inputs and outputs. Digital bits 0-7 are the standard, 8-15 the configurable, 16-17 the tool IOs. Analog
/// values are in A (current loop, 4-20 mA) or V (0-10 V); a set bit of the types selects voltage: bit 0 and 1
/// inputs, bit 2 and 3 outputs (UR, "RTDE Guide", analog_io_types).
struct Io {
  std::uint64_t digital_inputs = 0;
  std::uint64_t digital_outputs = 0;
  std::array<double, 2> analog_inputs{};
  std::array<double, 2> analog_outputs{};
  std::uint32_t analog_io_types = 0;
  std::array<double, 2> tool_analog_inputs{};
  std::uint32_t tool_analog_input_types = 0;
  std::int32_t tool_output_voltage = 0;
  double tool_output_current = 0.0;
  double tool_temperature = 30.0;
  std::int32_t tool_output_mode = 0;                            ///< 0 digital outputs, 1 dual pin power
  std::array<std::int32_t, 2> tool_digital_output_modes{1, 1};  ///< 1 sinking, 2 sourcing, 3 push/pull
  ToolCommunication tool_communication;
};

struct Payload {
  double mass = 0.0;                            ///< kg
  Vector3 center_of_gravity = Vector3::Zero();  ///< m, in the flange frame
  Vector6 inertia = Vector6::Zero();            ///< Ixx, Iyy, Izz, Ixy, Ixz, Iyz, kg m^2
};

/// Energy since the controller was switched on, J.
struct Energy {
  double consumed = 0.0;            ///< electrical power of the controller and motors that drive
  double braking_dissipated = 0.0;  ///< mechanical power of motors that brake
};

/// Settings of ft_rtde_input_enable(): readings received over RTDE replace those of the sensor in the flange.
struct ExternalSensor {
  bool enabled = false;
  double mass = 0.0;  ///< mass of the sensor, kg: the part of the payload that it does not measure
  Vector3 measuring_offset = Vector3::Zero();   ///< measuring point in the flange frame, m
  Vector3 center_of_gravity = Vector3::Zero();  ///< centre of gravity of the sensor in the flange frame, m
};

/// What may be a protective stop on a robot ("C204A3: sudden stop"), and is only counted here.
struct MotionLapses {
  std::uint32_t broken_off = 0;         ///< the program has ended a motion, and started no other at once
  std::uint32_t moves_from_motion = 0;  ///< paths that began while the arm moved, and not in a blend
};

struct JointState {
  Vector6 position = Vector6::Zero();      ///< rad
  Vector6 velocity = Vector6::Zero();      ///< rad/s
  Vector6 acceleration = Vector6::Zero();  ///< rad/s^2
  Vector6 current = Vector6::Zero();       ///< A
  Vector6 torque = Vector6::Zero();        ///< N m
};

/// What the sensors of the arm report.
struct Readings {
  Vector6 position = Vector6::Zero();                    ///< rad
  Vector6 current = Vector6::Zero();                     ///< A
  Vector6 tcp_pose = Vector6::Zero();                    ///< from these positions
  Vector3 tool_acceleration = Vector3(0.0, 0.0, -9.81);  ///< as ControllerState::tool_acceleration
};

/// The data that a control cycle reads and writes. Used on the controller's thread only. Poses, twists and
/// wrenches are those of the TCP in the base frame unless stated otherwise; forces are those that the
/// environment exerts on the tool.
struct ControllerState {
  std::uint64_t cycle = 0;
  double timestamp = 0.0;  ///< simulated time since start, cycle * cycle time, s

  MotionLapses lapses;
  JointState target;
  JointState actual;  ///< without noise
  Readings measured;  ///< the same with noise: what clients and programs see
  Vector6 joint_temperatures = Vector6::Constant(28.0);  ///< deg C
  std::array<std::int32_t, 6> joint_modes{};             ///< 253 RUNNING, 255 IDLE, 239 POWER_OFF, …

  Vector6 target_tcp_pose = Vector6::Zero();
  Vector6 target_tcp_speed = Vector6::Zero();
  Vector6 path_tcp_pose = Vector6::Zero();   ///< target without path offset
  Vector6 path_tcp_speed = Vector6::Zero();  ///< likewise
  Vector6 actual_tcp_pose = Vector6::Zero();
  Vector6 actual_tcp_speed = Vector6::Zero();
  Vector6 target_tcp_acceleration = Vector6::Zero();
  Vector6 actual_tcp_acceleration = Vector6::Zero();
  Vector6 reported_tcp_force = Vector6::Zero();  ///< get_tcp_force(): actual_tcp_force, but on e-Series at
                                                 ///< the flange, unless an external sensor measures it
  Vector6 actual_tcp_force = Vector6::Zero();    ///< filtered, without the payload's weight,
                                                 ///< relative to the last zeroing
  /// Wrench at the flange in flange axes, with the weight of the load, not zeroed.
  Vector6 ft_raw_wrench = Vector6::Zero();
  /// Wrench of surfaces and pushes on the tool, without noise, filter and load.
  Vector6 contact_wrench = Vector6::Zero();
  /// Disturbance of the motion control: the contact wrench and the weight of the load that the configured
  /// payload does not account for.
  Vector6 tool_wrench = Vector6::Zero();
  /// Reading of the accelerometer at the flange, in flange axes, m/s^2.
  Vector3 tool_acceleration = Vector3(0.0, 0.0, -9.81);

  Vector3 elbow_position = Vector3::Zero();  ///< intersection of upper arm and forearm, base frame, m
  Vector3 elbow_velocity = Vector3::Zero();  ///< m/s
  /// Wrench that the base exerts on the arm for the target motion: force, and moment about the base origin.
  Vector6 target_base_wrench = Vector6::Zero();

  /// Displacement of the TCP per force due to the elasticity of the joints, base axes, m/N. Written by Arm,
  /// read by World.
  Eigen::Matrix3d tcp_compliance = Eigen::Matrix3d::Zero();

  Vector6 tcp_offset = Vector6::Zero();  ///< pose of the TCP in the flange frame
  Payload payload;
  Vector3 gravity = Vector3(0.0, 0.0, 9.82);  ///< as in set_gravity(): opposite to the pull of gravity, m/s^2

  double speed_slider = 1.0;   ///< set on the pendant or over RTDE, 0..1
  double speed_scaling = 1.0;  ///< current scaling of the trajectory speed, ramps to the target fraction
  double target_speed_fraction = 1.0;  ///< the speed slider

  RobotMode robot_mode = RobotMode::power_off;
  SafetyMode safety_mode = SafetyMode::normal;
  RuntimeState runtime_state = RuntimeState::stopped;
  std::uint32_t robot_status_bits = 0;   ///< RTDE output, written by Safety::step
  std::uint32_t safety_status_bits = 0;  ///< RTDE output, written by Safety::step
  bool freedrive = false;
  bool in_force_mode = false;
  bool steady = true;
  double collision_force_ratio = 0.0;  ///< tool force as a fraction of the force that triggers a stop
  double joint_deviation_ratio = 0.0;  ///< largest servo error as a fraction of the one that triggers a stop
  TimeScaleSource time_scale_source = TimeScaleSource::none;
  Energy energy;

  ExternalSensor external_sensor;
  Io io;
  Registers inputs;   ///< written by RTDE clients, read by the program
  Registers outputs;  ///< written by the program, read by RTDE clients
  PortRegisters ports;
  Vector6 external_force_torque = Vector6::Zero();  ///< RTDE input, flange axes
  double actual_execution_time = 0.0;               ///< computation time of the last cycle, ms

  /// Bit 0 of robot_status_bits, "Is power on" (UR, "RTDE Guide").
  /// RTDE output speed_scaling: 0 while no program runs (recordings of robots).
  double reported_speed_scaling() const
  {
    return runtime_state == RuntimeState::stopped ? 0.0 : speed_scaling;
  }
  bool is_powered() const { return (robot_status_bits & 1U) != 0; }
};

}  // namespace ur_simulator
