#include "ur_ros_rtde/mode.hpp"

#include <fmt/format.h>

#include <exception>

#include "ur_ros_rtde/check_result.hpp"

namespace ur_ros_rtde {
namespace {
using Control = ur_rtde::RTDEControlInterface;
constexpr std::uint32_t all_modes = Control::MOTION_FORCE | Control::MOTION_FREEDRIVE | Control::MOTION_TEACH;

/// Throws RobotError (busy) if one of ur_rtde's `modes` (Control::MOTION_…) is active, which excludes
/// `requested_mode`.
void check_modes_inactive(Run & run, std::uint32_t modes, const std::string & requested_mode)
{
  const std::uint32_t active = run.control()->getStartedMotions() & modes;
  if (active == 0) {
    return;
  }
  const char * mode = (active & Control::MOTION_FREEDRIVE) != 0 ? "freedrive (end it: freedrive_stop)"
                      : (active & Control::MOTION_TEACH) != 0   ? "teach mode (end it: end_teach_mode)"
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
    if (on_ && (run_.control()->getStartedMotions() & ~(all_modes | Control::MOTION_CONTACT)) == 0) {
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
  check_modes_inactive(run, Control::MOTION_FREEDRIVE | Control::MOTION_TEACH, "force mode");
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
  check_modes_inactive(run, all_modes, "freedrive");
  check_result(run.control()->freedriveMode(to_int_flags(free_axes), feature), "enter freedrive");
  return {run, &Control::endFreedriveMode, "freedrive"};
}

Mode start_teach_mode(Run & run)
{
  check_modes_inactive(run, all_modes, "teach mode");
  check_result(run.control()->teachMode(), "enter teach mode");
  return {run, &Control::endTeachMode, "teach mode"};
}

}  // namespace ur_ros_rtde
