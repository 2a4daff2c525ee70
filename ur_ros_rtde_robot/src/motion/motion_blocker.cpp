#include "motion/motion_blocker.hpp"

#include <fmt/format.h>

namespace ur_ros_rtde {
namespace {

std::optional<Error> safety_blocker(const Sample & sample)
{
  const auto safety = sample.safety();
  if (safety.emergency_stopped || safety.robot_emergency_stopped || safety.system_emergency_stopped) {
    return Error{
        ErrorCode::emergency_stop,
        fmt::format(
            "the robot is in an emergency stop ({}): find out why, release the button, then make_ready "
            "(or dashboard/power_on and dashboard/brake_release)",
            to_string(sample.safety_mode))};
  }
  if (safety.fault || safety.violation) {
    return Error{
        ErrorCode::safety_violation,
        fmt::format("the safety system reports a {}: find the cause on the pendant, then make_ready with "
                    "restart_safety: true (or dashboard/restart_safety, power_on, brake_release)",
                    safety.fault ? "fault" : "violation")};
  }
  if (safety.protective_stopped) {
    return Error{ErrorCode::protective_stop,
                 "the robot is in a protective stop: remove what it ran into, then make_ready "
                 "(or dashboard/unlock_protective_stop)"};
  }
  if (safety.safeguard_stopped) {
    return Error{ErrorCode::safeguard_stop,
                 "the robot is in a safeguard stop: close the guard or reset the safeguard input"};
  }
  if (safety.recovery_mode) {
    return Error{
        ErrorCode::safety_violation,
        "the robot is in recovery mode, outside its safety limits: move it back inside on the pendant"};
  }
  if (safety.stopped_due_to_safety) {  // by PROFIsafe, an enabling device, a safety plane of an input, ...
    return Error{
        ErrorCode::safeguard_stop,
        fmt::format("the safety system has stopped the robot ({}): remove the cause that the pendant "
                    "shows",
                    to_string(sample.safety_mode))};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Error> motion_blocker(const Sample & sample)
{
  if (auto safety = safety_blocker(sample)) {
    return safety;
  }
  switch (sample.robot_mode) {
    case RobotMode::running:
      return std::nullopt;
    case RobotMode::power_off:
      return Error{ErrorCode::not_ready,
                   "the arm is powered off: make_ready (or dashboard/power_on and "
                   "dashboard/brake_release)"};
    case RobotMode::power_on:
    case RobotMode::idle:
      return Error{ErrorCode::not_ready,
                   fmt::format("the arm's brakes are closed (robot mode {}): make_ready (or "
                               "dashboard/brake_release)",
                               to_string(sample.robot_mode))};
    case RobotMode::backdrive:
      return Error{ErrorCode::not_ready, "the arm is in backdrive mode: leave it on the pendant"};
    default:
      return Error{
          ErrorCode::not_ready,
          fmt::format("the robot is not running (robot mode {}): wait for it, or look at the pendant",
                      to_string(sample.robot_mode))};
  }
}

}  // namespace ur_ros_rtde
