#include "ur_ros_rtde/mode.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>

#include "ur_ros_rtde/check_result.hpp"

namespace ur_ros_rtde {
namespace {
using Control = ur_rtde::RTDEControlInterface;

/// Throws RobotError (busy) if one of `modes` is active, which excludes `requested_mode`.
void check_modes_inactive(const Run & run, Activities modes, const std::string & requested_mode)
{
  const Activities active = run.robot().activities() & modes;
  if (active.empty()) {
    return;
  }
  const char * mode = active.contains(Activity::freedrive)    ? "freedrive (end it: freedrive_stop)"
                      : active.contains(Activity::teach_mode) ? "teach mode (end it: end_teach_mode)"
                                                              : "force mode (end it: force_mode_stop)";
  throw RobotError({ErrorCode::busy, fmt::format("no {} while the arm is in {}", requested_mode, mode)});
}

bool is_finite(double value)
{
  return std::isfinite(value);
}

geometry_msgs::msg::Vector3 to_vector3(const std::array<double, 6> & wrench, std::size_t begin)
{
  geometry_msgs::msg::Vector3 vector;
  vector.x = wrench[begin];
  vector.y = wrench[begin + 1];
  vector.z = wrench[begin + 2];
  return vector;
}

void check_stopped(const Outcome & stopped)
{
  if (!stopped) {
    throw RobotError(stopped.error());
  }
}

std::vector<int> to_int_flags(const std::array<bool, 6> & flags)
{
  return {flags.begin(), flags.end()};
}
}  // namespace

Mode::~Mode()
{
  try {
    if (on_ && !run_.stop_reason()) {
      check_stopped(run_.stop_motion());
      if (run_.robot().activities().without(outlasting_modes | Activity::contact_detection).empty()) {
        end();
      }
    }
  } catch (const std::exception & error) {
    if (!run_.stop_reason()) {
      run_.warn(error.what());
    }
  }
}

void Mode::end()
{
  if (std::exchange(on_, false)) {
    check_result(((*run_.control().hold()).*function_)(), "end " + name_);
  }
}

Check & check_force_mode(Check & check, const ForceModeOptions & options)
{
  constexpr double max_force = 500.0;   // N
  constexpr double max_torque = 100.0;  // Nm
  constexpr double max_limit = 10.0;    // m/s, rad/s, m or rad, depending on the axis
  check
      .that(options.task_frame.size() == 6 && std::ranges::all_of(options.task_frame, is_finite),
            "task_frame must have 6 finite values: position (m) and rotation vector (rad)")
      .that(std::ranges::any_of(options.compliant, std::identity()),
            "compliant is false for all axes: at least one axis has to be true")
      .vector("wrench.force", to_vector3(options.wrench, 0), max_force, "N")
      .vector("wrench.torque", to_vector3(options.wrench, 3), max_torque, "Nm")
      .in_range("type", options.type, 1, 3)
      .in_range("damping", options.damping, 0.0, 1.0)
      .in_range("gain_scaling", options.gain_scaling, 0.0, 2.0);
  for (std::size_t i = 0; i < options.limits.size(); ++i) {
    check.above_zero(fmt::format("limits[{}]", i), options.limits[i], max_limit);
  }
  return check;
}

Mode start_force_mode(Run & run, const ForceModeOptions & options)
{
  Check check;
  if (!check_force_mode(check, options).ok()) {
    throw RobotError(*check.error());
  }
  check_modes_inactive(run, hand_guiding, "force mode");
  check_result(run.control()->forceModeSetDamping(options.damping), "set the damping of force mode");
  check_result(run.control()->forceModeSetGainScaling(options.gain_scaling), "set the gain of force mode");
  check_result(run.control()->forceMode(options.task_frame, to_int_flags(options.compliant),
                                        {options.wrench.begin(), options.wrench.end()}, options.type,
                                        {options.limits.begin(), options.limits.end()}),
               "enter force mode");
  check_result(run.control()->waitUntilLastCommandExecuted(), "enter force mode");
  return {run, &Control::forceModeStop, "force mode"};
}

Mode start_freedrive(Run & run, const std::array<bool, 6> & free_axes, const std::vector<double> & feature)
{
  check_modes_inactive(run, outlasting_modes, "freedrive");
  check_result(run.control()->freedriveMode(to_int_flags(free_axes), feature), "enter freedrive");
  return {run, &Control::endFreedriveMode, "freedrive"};
}

Mode start_teach_mode(Run & run)
{
  check_modes_inactive(run, outlasting_modes, "teach mode");
  check_result(run.control()->teachMode(), "enter teach mode");
  return {run, &Control::endTeachMode, "teach mode"};
}

}  // namespace ur_ros_rtde
