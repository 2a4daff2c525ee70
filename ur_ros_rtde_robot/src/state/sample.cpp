#include "ur_ros_rtde_robot/state/sample.hpp"

#include <algorithm>

namespace ur_ros_rtde {

const char * to_string(RobotMode mode)
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

const char * to_string(SafetyMode mode)
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
      return "UNDEFINED";
    case SafetyMode::automatic_mode_safeguard_stop:
      return "AUTOMATIC_MODE_SAFEGUARD_STOP";
    case SafetyMode::system_three_position_enabling_stop:
      return "SYSTEM_THREE_POSITION_ENABLING_STOP";
    case SafetyMode::tp_three_position_enabling_stop:
      return "TP_THREE_POSITION_ENABLING_STOP";
    case SafetyMode::immi_emergency_stop:
      return "IMMI_EMERGENCY_STOP";
    case SafetyMode::immi_safeguard_stop:
      return "IMMI_SAFEGUARD_STOP";
    case SafetyMode::profisafe_waiting_for_parameters:
      return "PROFISAFE_WAITING_FOR_PARAMETERS";
    case SafetyMode::profisafe_automatic_mode_safeguard_stop:
      return "PROFISAFE_AUTOMATIC_MODE_SAFEGUARD_STOP";
    case SafetyMode::profisafe_safeguard_stop:
      return "PROFISAFE_SAFEGUARD_STOP";
    case SafetyMode::profisafe_emergency_stop:
      return "PROFISAFE_EMERGENCY_STOP";
    case SafetyMode::safety_api_safeguard_stop:
      return "SAFETY_API_SAFEGUARD_STOP";
    case SafetyMode::io_plane_stop:
      return "IO_PLANE_STOP";
  }
  return "UNKNOWN";
}

const char * to_string(RuntimeState state)
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

SafetyBits Sample::safety() const
{
  const auto bit = [this](unsigned index) { return (safety_status_bits >> index & 1U) != 0; };
  return {bit(0), bit(1), bit(2), bit(3), bit(4), bit(5), bit(6), bit(7), bit(8), bit(9), bit(10)};
}

}  // namespace ur_ros_rtde
