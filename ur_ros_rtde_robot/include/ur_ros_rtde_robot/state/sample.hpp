#pragma once

#include <algorithm>
#include <array>
#include <bitset>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "ur_ros_rtde_trajectory/vector.hpp"

namespace ur_ros_rtde {

/// RTDE's robot_mode (UR, "Real-Time Data Exchange (RTDE) Guide").
enum class RobotMode : std::int32_t {
  no_controller = -1,
  disconnected = 0,
  confirm_safety = 1,
  booting = 2,
  power_off = 3,
  power_on = 4,
  idle = 5,
  backdrive = 6,
  running = 7,
  updating_firmware = 8,
};

/// RTDE's safety_mode (ur_client_library and ur_dashboard_msgs have those from 12 on).
enum class SafetyMode : std::int32_t {
  normal = 1,
  reduced = 2,
  protective_stop = 3,
  recovery = 4,
  safeguard_stop = 5,
  system_emergency_stop = 6,
  robot_emergency_stop = 7,
  violation = 8,
  fault = 9,
  validate_joint_id = 10,
  undefined = 11,
  automatic_mode_safeguard_stop = 12,
  system_three_position_enabling_stop = 13,
  tp_three_position_enabling_stop = 14,
  immi_emergency_stop = 15,
  immi_safeguard_stop = 16,
  profisafe_waiting_for_parameters = 17,
  profisafe_automatic_mode_safeguard_stop = 18,
  profisafe_safeguard_stop = 19,
  profisafe_emergency_stop = 20,
  safety_api_safeguard_stop = 22,
  io_plane_stop = 23,
};

/// RTDE's runtime_state: state of the robot program.
enum class RuntimeState : std::uint32_t {
  stopping = 0,
  stopped = 1,
  playing = 2,
  pausing = 3,
  paused = 4,
  resuming = 5,
};

const char * to_string(RobotMode mode);
const char * to_string(SafetyMode mode);
const char * to_string(RuntimeState state);

/// The bits of RTDE's safety_status_bits.
struct SafetyBits {
  bool normal_mode, reduced_mode, protective_stopped, recovery_mode, safeguard_stopped,
      system_emergency_stopped, robot_emergency_stopped, emergency_stopped, violation, fault,
      stopped_due_to_safety;
};

/// Status of asynchronous moves, which ur_rtde's control script writes into output integer register 2.
struct AsyncStatus {
  std::uint32_t word = 0;

  bool running() const { return (word & 0x8000U) != 0; }
  /// 0..127, incremented when an operation begins (twice for an asynchronous path).
  unsigned operation() const { return (word >> 24U) & 0x7FU; }
  /// 0..127, incremented with each write: two different values mean that the status was written in between.
  unsigned changes() const { return (word >> 16U) & 0xFFU; }
  /// Index of the current waypoint of a path; 0 for other moves.
  unsigned progress() const { return word & 0x7FFFU; }
  bool operator==(const AsyncStatus & other) const { return word == other.word; }
  /// An operation has begun since `before`, a status of the same program that may also be a newer one.
  bool has_begun_since(const AsyncStatus & before) const
  {
    const unsigned begun = (operation() - before.operation()) & 0x7FU;
    return begun != 0 && begun < 0x40U;
  }
};

/// All fields of one RTDE package, which belong to the same control cycle. Copied without allocation. Numbers
/// that the controller's version does not provide are NaN; modes, bits, registers and the two speed fractions
/// exist in every version.
struct Sample {
  /// Number of packages since the receiver was created, across reconnections; 0: no package yet.
  std::uint64_t sequence = 0;
  /// Incremented with each reconnection. controller_time may have restarted (reboot).
  std::uint32_t link = 0;
  /// s since the controller started.
  double controller_time = 0.0;
  /// Arrival of the package at this host: steady time for durations, system time for stamps.
  std::chrono::steady_clock::time_point received;
  std::chrono::system_clock::time_point stamp;

  Vector6 target_q, target_qd, target_qdd, target_current, target_moment;
  Vector6 actual_q, actual_qd, actual_current;
  Vector6 actual_current_as_torque;  ///< Nm, PolyScope 5.23 and later
  Vector6 joint_control_output;      ///< A
  Vector6 joint_temperatures;        ///< degrees Celsius
  Vector6 actual_joint_voltage;
  std::array<std::int32_t, 6> joint_mode;

  /// Pose and velocity of the active TCP in the base frame.
  Vector6 actual_tcp_pose, actual_tcp_speed, target_tcp_pose, target_tcp_speed;
  Vector6 tcp_offset;  ///< pose of the active TCP in the flange frame; PolyScope 3.12, 5.5.1 and later
  /// Wrench that the environment exerts on the tool, at the TCP, in the orientation of the base frame;
  /// compensated for the payload. (RTDE's actual_TCP_force of an e-Series is that at the flange:
  /// Universal_Robots_ROS2_Driver, pull request 1287.) Without tcp_offset, its
  /// torque is that of RTDE; with an external sensor, which RTDE reports at the TCP, it is wrong.
  Vector6 actual_tcp_force;
  Vector6 ft_raw_wrench;  ///< of the force/torque sensor, in the flange frame, not compensated; PolyScope 5.9
                          ///< and later
  Vector3 actual_tool_accelerometer;

  RobotMode robot_mode;
  SafetyMode safety_mode;
  RuntimeState runtime_state;
  std::uint32_t robot_status_bits;  ///< 0 power on, 1 program running, 2 teach button, 3 power button
  std::uint32_t safety_status_bits;

  double speed_scaling;          ///< 0..1, current speed of the trajectory
  double target_speed_fraction;  ///< 0..1, the speed slider
  double actual_execution_time;  ///< ms
  double actual_momentum, actual_main_voltage, actual_robot_voltage, actual_robot_current;

  /// Bits 0-7 standard, 8-15 configurable, 16-17 tool.
  std::uint64_t digital_inputs, digital_outputs;
  std::array<double, 2> analog_inputs, analog_outputs;  ///< A or V

  double payload;           ///< kg
  Vector3 payload_cog;      ///< m, in the flange frame
  Vector6 payload_inertia;  ///< kg m^2: Ixx, Iyy, Izz, Ixy, Ixz, Iyz

  AsyncStatus async;                                 ///< output integer register 2 (+ register offset)
  static constexpr int first_output_register = 12;   ///< + register offset
  std::array<std::int32_t, 8> output_int_registers;  ///< 12-19
  std::array<double, 8> output_double_registers;     ///< 12-19

  SafetyBits safety() const;
  bool is_powered_on() const { return (robot_status_bits & 1U) != 0; }
  /// See script_extension.hpp: 0 when no extension runs, its number when it has finished.
  double extension_acknowledgement() const { return output_double_registers[18 - first_output_register]; }
  /// Time of servoJ's target after that of the newest setpoint, in cycles; below -1 if setpoints came in a
  /// bunch: see SetpointClock.
  double servo_ahead() const { return output_double_registers[12 - first_output_register]; }
  /// 0..1, at which motions advance: the smaller one, because only some controllers include the slider in
  /// speed_scaling.
  double requested_rate() const
  {
    return std::clamp(std::fmin(speed_scaling, target_speed_fraction), 0.0, 1.0);
  }
  /// A program of the robot plays, of the driver or another one.
  bool is_program_running() const { return runtime_state == RuntimeState::playing; }
};

static_assert(std::is_trivially_copyable_v<Sample>);

}  // namespace ur_ros_rtde
