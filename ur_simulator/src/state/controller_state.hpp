#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <string>

#include "common/types.hpp"
#include "state/modes.hpp"

namespace ur_simulator {

/// Registers that RTDE clients and the robot program exchange. Sizes as of PolyScope 5.
struct Registers {
  std::bitset<128> bits;
  std::array<std::int32_t, 48> integers{};
  std::array<double, 48> doubles{};
};

/// Digital bits 0-7 standard, 8-15 configurable, 16-17 tool; analog 0-1, current loop 4-20 mA (A) or voltage
/// 0-10 V.
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
};

struct Payload {
  double mass = 0.0;                            ///< kg
  Vector3 center_of_gravity = Vector3::Zero();  ///< m, in the flange frame
  Vector6 inertia = Vector6::Zero();            ///< Ixx, Iyy, Izz, Ixy, Ixz, Iyz, kg m^2
};

/// ft_rtde_input_enable(): a sensor whose readings come by RTDE takes the place of the one in the flange.
struct ExternalSensor {
  bool enabled = false;
  double mass = 0.0;                           ///< kg, of the sensor: part of the payload that it cannot feel
  Vector3 measuring_offset = Vector3::Zero();  ///< m, of its measuring point in the flange frame
  Vector3 center_of_gravity = Vector3::Zero();  ///< m, of the sensor in the flange frame
};

struct JointState {
  Vector6 position = Vector6::Zero();      ///< rad
  Vector6 velocity = Vector6::Zero();      ///< rad/s
  Vector6 acceleration = Vector6::Zero();  ///< rad/s^2
  Vector6 current = Vector6::Zero();       ///< A
  Vector6 torque = Vector6::Zero();        ///< N m
};

/// Everything that one control cycle reads and writes; its only owner is the controller's thread. Poses,
/// twists and wrenches are those of the TCP in the robot's base frame; forces are what the surroundings exert
/// on the tool.
struct ControllerState {
  std::uint64_t cycle = 0;
  double timestamp = 0.0;  ///< s since start, cycle * cycle time: the clock of the simulation

  JointState target;
  JointState actual;
  Vector6 joint_temperatures = Vector6::Constant(28.0);  ///< deg C
  std::array<std::int32_t, 6> joint_modes{};             ///< 253 RUNNING, 255 IDLE, 239 POWER_OFF, …

  Vector6 target_tcp_pose = Vector6::Zero();
  Vector6 target_tcp_speed = Vector6::Zero();
  Vector6 actual_tcp_pose = Vector6::Zero();
  Vector6 actual_tcp_speed = Vector6::Zero();
  Vector6 actual_tcp_force = Vector6::Zero();  ///< filtered, payload subtracted, zeroed: as get_tcp_force()
  Vector6 ft_raw_wrench =
      Vector6::Zero();  ///< at and in the flange frame, with the weight of the load, not zeroed
  Vector6 contact_wrench =
      Vector6::Zero();  ///< what surfaces and hands truly do to the tool: no noise, filter or load
  /// What pushes the tool beyond what the controller knows: contact, and the weight of a load that differs
  /// from the payload that was set.
  Vector6 tool_wrench = Vector6::Zero();
  Vector3 tool_acceleration =
      Vector3(0.0, 0.0, -9.81);  ///< accelerometer at the flange, in flange axes, m/s^2

  /// How far the TCP gives way to a force, m/N in base axes: the joints' elasticity. Written by Arm, read by
  /// World.
  Eigen::Matrix3d tcp_compliance = Eigen::Matrix3d::Zero();

  Vector6 tcp_offset = Vector6::Zero();  ///< pose of the TCP in the flange frame
  Payload payload;
  Vector3 gravity = Vector3(0.0, 0.0, 9.82);  ///< as set_gravity(): opposes the pull

  double speed_slider = 1.0;           ///< what a person or RTDE set, 0..1
  double speed_scaling = 1.0;          ///< how fast the trajectory really runs, ramps towards the target
  double target_speed_fraction = 1.0;  ///< what speed_scaling ramps to: the slider, 0 while paused

  RobotMode robot_mode = RobotMode::power_off;
  SafetyMode safety_mode = SafetyMode::normal;
  RuntimeState runtime_state = RuntimeState::stopped;
  std::uint32_t robot_status_bits = 0;   ///< as RTDE's, written by Safety::step
  std::uint32_t safety_status_bits = 0;  ///< as RTDE's, written by Safety::step
  bool freedrive = false;
  bool in_force_mode = false;
  bool steady = true;
  double collision_force_ratio = 0.0;

  ExternalSensor external_sensor;
  Io io;
  Registers inputs;                                 ///< written by RTDE clients, read by the program
  Registers outputs;                                ///< written by the program, read by RTDE clients
  Vector6 external_force_torque = Vector6::Zero();  ///< RTDE input, flange axes
  double actual_execution_time = 0.0;               ///< ms the last cycle took
};

}  // namespace ur_simulator
