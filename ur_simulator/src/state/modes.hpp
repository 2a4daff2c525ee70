#pragma once

#include <cstdint>
#include <string_view>

namespace ur_simulator {

// Values of the RTDE outputs robot_mode, safety_mode and runtime_state (UR, "Real-Time Data Exchange (RTDE)
// Guide").

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
};

enum class RuntimeState : std::uint32_t {
  stopping = 0,
  stopped = 1,
  playing = 2,
  pausing = 3,
  paused = 4,
  resuming = 5
};

/// What slows the motion down: RTDE output time_scale_source, while a program runs.
enum class TimeScaleSource : std::int32_t { none = 1, joint_speed_limit = 10 };

/// The spelling of the dashboard server: POWER_OFF, RUNNING, …, NORMAL, PROTECTIVE_STOP, …
std::string_view to_string(RobotMode mode);
std::string_view to_string(SafetyMode mode);
std::string_view to_string(RuntimeState state);

/// Whether the arm may move in this safety mode.
bool allows_motion(SafetyMode mode);

}  // namespace ur_simulator
