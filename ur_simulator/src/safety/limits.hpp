#pragma once

namespace ur_simulator {

/// What the safety system watches over. The defaults and their sources stand in docs/simulator_physics.md.
struct SafetyLimits {
  double tool_speed = 5.0;    ///< m/s of the TCP
  double tool_force = 150.0;  ///< N at the TCP, sustained
  double tool_force_time =
      0.1;  ///< s: the force that is compared is low-pass filtered with this time constant
  double tool_force_peak = 500.0;   ///< N, at once
  double joint_speed_margin = 0.1;  ///< over the model's joint speed limit, as a fraction of it
  bool monitor = true;              ///< false: nothing trips by itself
};

/// How long what takes time on a robot takes here, in s of simulated time.
struct SafetyTimes {
  double power_on = 1.5;       ///< POWER_OFF -> IDLE, with BOOTING / POWER_ON in between
  double brake_release = 1.0;  ///< IDLE -> RUNNING
  double unlock_delay = 5.0;   ///< a protective stop cannot be unlocked earlier
  double stop_limit =
      0.5;               ///< after an emergency stop power is cut when the arm has not come to rest by then
  double restart = 2.5;  ///< restart safety: POWER_OFF after this
};

}  // namespace ur_simulator
