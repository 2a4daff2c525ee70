#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace ur_ros_rtde {

enum class ControlMode {
  upload,         ///< the driver sends ur_rtde's control script; requires remote control on e-Series
  control_urcap,  ///< the External Control URCap fetches the script when its program is played on the robot
};

constexpr double min_watchdog_frequency = 1.0;  // Hz
/// A CB3 controller sends a package, and receives a heartbeat, every 8 ms: two within 1/50 s.
constexpr double max_watchdog_frequency = 50.0;  // Hz
/// What is wrong with a value of RobotOptions::watchdog_frequency; empty if nothing is.
std::string watchdog_frequency_problem(double frequency);

struct RobotOptions {
  std::string address;
  /// Hz, rate of the samples; see StateReceiverOptions.
  double frequency = 0.0;
  ControlMode control_mode = ControlMode::upload;
  std::uint16_t urcap_port = 50002;
  /// With control_urcap: the robot has the URCaps whose functions extensions need. Otherwise these are not in
  /// the program, because PolyScope does not start one with an unknown function.
  bool urcap_extensions = false;
  /// Use the general purpose registers 24-47 instead of 0-23, for example if a fieldbus uses the lower range.
  /// The mass matrix and the Jacobians of PolyScope 5.23 and later need registers of both ranges and are not
  /// available then.
  bool upper_range_registers = false;
  /// Model of the arm, see arm_limits(); empty: as reported by the controller. If it contradicts the
  /// controller, motions are rejected.
  std::string model;
  std::chrono::milliseconds connect_timeout{500};
  std::chrono::milliseconds retry_interval{250};
  std::chrono::milliseconds silence_limit{100};
  /// Hz, min_watchdog_frequency to max_watchdog_frequency; 0: no watchdog. The robot program stops the arm if
  /// it receives no heartbeat from this process for 1/watchdog_frequency s.
  double watchdog_frequency = 10.0;
  /// Restart the control program after it was stopped (with control_urcap: by a lost connection), as soon as
  /// the robot is ready. An interrupted motion is never resumed.
  bool restart_program = true;
  /// SCHED_FIFO priority, 1 to 99, of the threads that answer each package with a target: the receiving
  /// thread and the threads that send a sequence of targets. 0: none. Logs a warning if not permitted.
  int realtime_priority = 0;
};

}  // namespace ur_ros_rtde
