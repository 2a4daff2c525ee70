#include "state/modes.hpp"

namespace ur_simulator {

std::string_view to_string(RobotMode mode)
{
  switch (mode) {
    case RobotMode::no_controller:
      return "NO_CONTROLLER";
    case RobotMode::disconnected:
      return "DISCONNECTED";
    case RobotMode::confirm_safety:
      return "CONFIRM_SAFETY";
    case RobotMode::booting:
      return "BOOTING";
    case RobotMode::power_off:
      return "POWER_OFF";
    case RobotMode::power_on:
      return "POWER_ON";
    case RobotMode::idle:
      return "IDLE";
    case RobotMode::backdrive:
      return "BACKDRIVE";
    case RobotMode::running:
      return "RUNNING";
    case RobotMode::updating_firmware:
      return "UPDATING_FIRMWARE";
  }
  return "UNKNOWN";
}

std::string_view to_string(SafetyMode mode)
{
  switch (mode) {
    case SafetyMode::normal:
      return "NORMAL";
    case SafetyMode::reduced:
      return "REDUCED";
    case SafetyMode::protective_stop:
      return "PROTECTIVE_STOP";
    case SafetyMode::recovery:
      return "RECOVERY";
    case SafetyMode::safeguard_stop:
      return "SAFEGUARD_STOP";
    case SafetyMode::system_emergency_stop:
      return "SYSTEM_EMERGENCY_STOP";
    case SafetyMode::robot_emergency_stop:
      return "ROBOT_EMERGENCY_STOP";
    case SafetyMode::violation:
      return "VIOLATION";
    case SafetyMode::fault:
      return "FAULT";
    case SafetyMode::validate_joint_id:
      return "VALIDATE_JOINT_ID";
    case SafetyMode::undefined:
      return "UNDEFINED_SAFETY_MODE";
  }
  return "UNKNOWN";
}

std::string_view to_string(RuntimeState state)
{
  switch (state) {
    case RuntimeState::stopping:
      return "STOPPING";
    case RuntimeState::stopped:
      return "STOPPED";
    case RuntimeState::playing:
      return "PLAYING";
    case RuntimeState::pausing:
      return "PAUSING";
    case RuntimeState::paused:
      return "PAUSED";
    case RuntimeState::resuming:
      return "RESUMING";
  }
  return "UNKNOWN";
}

bool allows_motion(SafetyMode mode)
{
  return mode == SafetyMode::normal || mode == SafetyMode::reduced || mode == SafetyMode::recovery;
}

}  // namespace ur_simulator
