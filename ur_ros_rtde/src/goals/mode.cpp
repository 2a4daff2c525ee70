#include "ur_ros_rtde/mode.hpp"

#include <fmt/format.h>

#include <exception>

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

std::vector<int> to_int_flags(const std::array<bool, 6> & flags)
{
  return {flags.begin(), flags.end()};
}
}  // namespace

Mode::~Mode()
{
  try {
    if (on_ && run_.robot().activities().without(outlasting_modes | Activity::contact_detection).empty()) {
      end();
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

Mode start_force_mode(Run & run, const ForceModeOptions & options)
{
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
