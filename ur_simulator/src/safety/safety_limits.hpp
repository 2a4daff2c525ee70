#pragma once

namespace ur_simulator {

/// Limits that the safety system monitors. docs/internals/simulator_physics.md gives the sources of the
/// defaults.
struct SafetyLimits {
  double tool_speed = 5.0;              ///< m/s of the TCP
  double tool_force = 150.0;            ///< N at the TCP, sustained
  double tool_force_filter_time = 0.1;  ///< s, time constant of the low-pass filter of the sustained force
  double tool_force_peak = 500.0;       ///< N, unfiltered
  double joint_speed_margin = 0.1;      ///< above the joint speed limit of the model, as a fraction of it
  bool monitor = true;                  ///< false: no limit triggers a protective stop
};

/// Durations of the robot's state changes, s of simulated time.
struct SafetyTimes {
  double power_on = 1.5;       ///< POWER_OFF -> IDLE, with BOOTING / POWER_ON in between
  double brake_release = 1.0;  ///< IDLE -> RUNNING
  double unlock_delay = 5.0;   ///< from a protective stop until it can be unlocked
  double stop_limit = 0.5;     ///< after an emergency stop the power is cut even if the arm still moves
  double restart = 2.5;        ///< restart safety, until POWER_OFF
};

}  // namespace ur_simulator
