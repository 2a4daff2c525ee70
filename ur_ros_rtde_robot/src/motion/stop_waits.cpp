// The waits of a stop. Run on the stopper's thread.
#include <chrono>

#include "connection/skew.hpp"
#include "motion/motion_stopper.hpp"

namespace ur_ros_rtde {

using std::chrono::milliseconds;

bool MotionStopper::wait_for(double timeout, const std::function<bool(const Sample &)> & condition) const
{
  Sample sample = state_.latest().value_or(Sample{});
  const double deadline = sample.controller_time + timeout;
  while (!condition(sample)) {
    if (!state_.link().connected || options_changed_ || sample.controller_time > deadline) {
      return false;
    }
    state_.wait_for_next(sample, milliseconds(20));
  }
  return true;
}

bool MotionStopper::wait_for_standstill(double timeout, const StopOptions & options) const
{
  const auto begin = tracker_.view();
  const double late = lateness();  // what has queued up since shows an earlier standstill
  const bool mode_stays = activities_.now().contains_any(options.keep);
  return wait_for(timeout + late, [&](const Sample &) {
    const auto view = tracker_.view();
    return view.sequence >= begin.sequence + sample_delay &&
           view.controller_time >= begin.controller_time + late && (view.at_rest || mode_stays) &&
           !view.operating();
  });
}

/// Waits for the begin of a script that was sent, or for what tells that it will not begin. False if there is
/// no such script, or no longer. `before`: no program ran.
bool MotionStopper::script_begins(const MotionTracker::View & before) const
{
  const auto has_script = [this] { return activities_.now().contains(Activity::script); };
  const double limit = std::chrono::duration<double>(StartedActivities::Script::begin_limit).count();
  return has_script() &&
         wait_for(limit,
                  [&](const Sample &) {
                    const auto view = tracker_.view();
                    return view.program_running || view.program != before.program ||
                           activities_.script_compiled() || !has_script();
                  }) &&
         has_script();
}

bool MotionStopper::wait_for_present() const
{
  const double late = lateness();
  const double limit = program_stop_timeout + late;
  const auto host_limit = Clock::now() + std::chrono::duration<double>(limit);
  const double present =
      tracker_.view().controller_time + late + static_cast<double>(sample_delay) * cycle_time();
  const auto is_present = [&] { return tracker_.view().controller_time >= present; };
  wait_for(limit, [&](const Sample &) { return is_present() || Clock::now() > host_limit; });
  return is_present();
}

double MotionStopper::lateness() const
{
  const auto sample = state_.latest();
  const auto age = sample ? Clock::now() - sample->received : Clock::duration::zero();
  return age > max_skew ? std::chrono::duration<double>(age).count() : 0.0;
}

}  // namespace ur_ros_rtde
