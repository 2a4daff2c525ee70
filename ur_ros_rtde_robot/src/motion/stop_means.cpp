// The means of a stop. Runs on the stopper's thread.
#include <fmt/format.h>
#include <ur_rtde/rtde_control_interface.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "connection/dashboard_request.hpp"
#include "connection/skew.hpp"
#include "motion/deceleration_check.hpp"
#include "motion/motion_stopper.hpp"
#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {
namespace {

using Control = ur_rtde::RTDEControlInterface;
using std::chrono::milliseconds;

/// To take the control interface from a call of another thread, which is abandoned.
constexpr milliseconds lock_timeout(12);
/// Control cycles in which the control program becomes ready for a command, and then acknowledges it, unless
/// it executes a blocking one.
constexpr double ready_cycles = 4;
constexpr double stop_cycles = 5;
/// s of the controller. The end of a mode may decelerate the arm.
constexpr double mode_end_timeout = 0.5;
/// From the acknowledgement of a stop to the sample that shows its beginning.
constexpr double begin_timeout = 0.04;

constexpr Activities joint_motions = Activity::joint_move | Activity::joint_speed | Activity::joint_servo;
constexpr Activities linear_motions =
    Activity::linear_move | Activity::linear_speed | Activity::linear_servo | Activity::jog;
/// stopJ and stopL end the contact detection too, with a contact that it has detected and not executed.
constexpr Activities motions = joint_motions | linear_motions | Activity::contact_detection;

/// The functions of ur_rtde that end what stopJ and stopL do not end, in the order in which they are called:
/// the arm is at rest by then, so that ending a mode does not disturb a motion.
struct ModeEnd {
  Activity mode;
  const char * name;
  bool (Control::*end)();
};
constexpr std::array<ModeEnd, 3> mode_ends{{{Activity::force_mode, "force mode", &Control::forceModeStop},
                                            {Activity::freedrive, "freedrive", &Control::endFreedriveMode},
                                            {Activity::teach_mode, "teach mode", &Control::endTeachMode}}};

/// Limits the waits of the commands of a stop.
class CommandTimeouts {
 public:
  CommandTimeouts(Control & control, double ready, double answer) : control_(control)
  {
    control_.setReadyTimeout(to_milliseconds(ready));
    control_.setCommandTimeout(to_milliseconds(answer));
  }
  ~CommandTimeouts()
  {
    control_.setReadyTimeout(std::chrono::seconds(UR_GET_READY_TIMEOUT));
    control_.setCommandTimeout(std::chrono::seconds(UR_EXECUTION_TIMEOUT));
  }
  CommandTimeouts(const CommandTimeouts &) = delete;
  CommandTimeouts & operator=(const CommandTimeouts &) = delete;

 private:
  static milliseconds to_milliseconds(double seconds)
  {
    return std::chrono::ceil<milliseconds>(std::chrono::duration<double>(seconds));
  }
  Control & control_;
};

/// s, generously: the check of the deceleration finds a stop that has no effect.
double deceleration_timeout(const Sample & sample, const StopOptions & options)
{
  if (options.timeout) {
    return std::chrono::duration<double>(*options.timeout).count();
  }
  double joint = 0.0;
  for (const double velocity : sample.target_qd) {
    joint = std::max(joint, std::abs(velocity));
  }
  const double expected = std::max(joint / options.joint_deceleration,
                                   length(position(sample.target_tcp_speed)) / options.linear_deceleration);
  return std::max(3.0, 1.0 + 1.5 * expected);
}

}  // namespace

std::span<const MotionStopper::Means> MotionStopper::means()
{
  static constexpr std::array<Means, 3> all{{{StopMeans::stop_command, &MotionStopper::stop_by_command},
                                             {StopMeans::program_stopped, &MotionStopper::stop_by_dashboard},
                                             {StopMeans::watchdog, &MotionStopper::stop_by_watchdog}}};
  static_assert(std::ranges::is_sorted(all, {}, &Means::means));
  return all;
}

Status MotionStopper::with_control(double answer_timeout, const std::function<bool(Control &)> & command)
{
  const auto control = interfaces_.control_interface();
  if (!control) {
    return failure(ErrorCode::not_ready, "the control program does not run");
  }
  const auto lock = interfaces_.take_control_lock(*control, lock_timeout);
  if (!lock) {
    return failure(ErrorCode::busy, "another call occupies the control interface");
  }
  try {
    const CommandTimeouts timeouts(*control, ready_cycles * cycle_time(), answer_timeout);
    return command(*control)
               ? Status()
               : failure(ErrorCode::rejected_by_robot, "the control program did not take the command");
  } catch (const std::exception & error) {
    return failure(ErrorCode::rejected_by_robot, error.what());
  }
}

/// Afterwards, it is known what the call has started, and it starts nothing else.
Status MotionStopper::end_call_of_revoked_holder()
{
  return activities_.now().contains(Activity::call) ? with_control(0.0, [](Control &) { return true; })
                                                    : Status();
}

Status MotionStopper::stop_by_command(const StopOptions & options)
{
  if (has_given_up_program()) {
    return failure(ErrorCode::not_ready, "the connection to the control program is closed");
  }
  if (Status ended = end_call_of_revoked_holder(); !ended) {
    return ended;
  }
  const Activities started = activities_.now().without(options.keep);
  if (started.contains(Activity::script)) {
    return failure(ErrorCode::not_ready, "a script runs in place of the control program");
  }
  if (started.contains(Activity::extension)) {
    if (Status cleared = registers_.clear_trigger(); !cleared) {
      return cleared;
    }
  }
  if (started.contains(Activity::torque)) {
    // The program ends, and with it everything that it does. It may end without having confirmed the command.
    const auto program = tracker_.view().program;
    const Status sent =
        with_control(mode_end_timeout, [](Control & control) { return control.stopScript(); });
    if (Status ended = wait_for_program_end(program, sent ? program_stop_timeout : begin_timeout); !ended) {
      return sent ? ended : sent;
    }
    return stop_motions({}, options);
  }
  if (Status stopped = stop_motions(started, options); !stopped) {
    return stopped;
  }
  if (Status ended = end_modes(started); !ended) {
    return ended;
  }
  return wait_for_standstill(program_stop_timeout, options)
             ? Status()
             : failure(ErrorCode::timeout, "the arm does not come to rest after the stop command");
}

Status MotionStopper::send_stop(Activities started, const StopOptions & options)
{
  // Without a motion of these kinds, it is a stop that becomes stronger.
  if (started.contains_any(motions)) {
    stops_in_joint_space_ = !started.contains_any(linear_motions);
  }
  return with_control(stop_cycles * cycle_time(), [&](Control & control) {
    constexpr std::uint32_t stopped = Control::MOTION_MOVE_JOINT | Control::MOTION_MOVE_LINEAR |
                                      Control::MOTION_SPEED_JOINT | Control::MOTION_SPEED_LINEAR |
                                      Control::MOTION_SERVO_JOINT | Control::MOTION_SERVO_LINEAR |
                                      Control::MOTION_JOG | Control::MOTION_CONTACT;
    if (stops_in_joint_space_) {
      control.stopJ(options.joint_deceleration, true);
    } else {
      control.stopL(options.linear_deceleration, true);
    }
    return (control.getStartedMotions() & stopped) == 0;
  });
}

/// Sends the stop if there is a motion that the control program executes, and waits until the arm is at rest
/// or, with a mode that moves it, until the motions have ended.
Status MotionStopper::stop_motions(Activities started, const StopOptions & options)
{
  const auto before = tracker_.view();
  const bool sends_stop = started.contains_any(motions) || before.operating();
  if (sends_stop) {
    // Two threads that move the arm end the program: the extension first, which decelerates by itself.
    if (started.contains(Activity::extension) && !wait_for(program_stop_timeout, [](const Sample & now) {
          return now.extension_acknowledgement() == 0.0;
        })) {
      return failure(ErrorCode::timeout, "the extension does not end");
    }
    if (Status sent = send_stop(started, options); !sent) {
      return sent;
    }
    if (!wait_for(begin_timeout, [&](const Sample &) {
          return tracker_.view().async.operation() != before.async.operation();
        })) {
      return failure(ErrorCode::rejected_by_robot, "the control program has not begun the stop");
    }
  }
  const Sample sample = state_.latest().value_or(Sample{});
  const bool mode_stays = activities_.now().contains_any(options.keep);  // and may go on moving the arm
  const auto has_ended = [&](const Sample & now) {
    const auto view = tracker_.view();
    const bool extension_ended = !started.contains(Activity::extension) || !view.program_running ||
                                 now.extension_acknowledgement() == 0.0;
    const bool rests = view.at_rest || mode_stays || started.contains_any(outlasting_modes);
    return view.sequence >= before.sequence + sample_delay && !view.operating() && extension_ended && rests;
  };
  DecelerationCheck deceleration;
  bool decelerates = true;
  const bool ended = wait_for(deceleration_timeout(sample, options), [&](const Sample & now) {
    decelerates = mode_stays || deceleration.add(now);
    return has_ended(now) || !decelerates;
  });
  if (!decelerates && !has_ended(state_.latest().value_or(Sample{}))) {
    return failure(ErrorCode::timeout, "the stop command has no effect");
  }
  return ended ? Status() : failure(ErrorCode::timeout, "the arm is not at rest after the stop command");
}

Status MotionStopper::end_modes(Activities started)
{
  for (const ModeEnd & mode : mode_ends) {
    if (!started.contains(mode.mode)) {
      continue;
    }
    if (Status ended =
            with_control(mode_end_timeout, [&](Control & control) { return (control.*mode.end)(); });
        !ended) {
      return failure(ended.error().code,
                     fmt::format("{} has not ended: {}", mode.name, ended.error().message));
    }
  }
  return {};
}

/// Success also without an answer in time if the samples will show the end of the program.
Status MotionStopper::request_program_stop(bool end_is_seen) const
{
  constexpr milliseconds answer_timeout(500);
  Status stopped = stop_program(options_.address, answer_timeout);
  return end_is_seen && !stopped && stopped.error().code == ErrorCode::timeout ? Status() : stopped;
}

Status MotionStopper::stop_by_dashboard(const StopOptions & options)
{
  const auto before = tracker_.view();
  activities_.fence_script();
  const bool may_begin =
      !before.program_running && activities_.now().contains(Activity::script);  // a script, after the stop
  const Status ended = may_begin ? stop_script(before) : request_program_stop(before.program_running);
  if (!ended) {
    return ended;
  }
  if (before.program_running) {
    if (Status seen = wait_for_program_end(before.program, program_stop_timeout); !seen) {
      return seen;
    }
  }
  return wait_for_standstill(program_stop_timeout, options)
             ? Status()
             : failure(ErrorCode::timeout, "the arm moves although its program was stopped");
}

/// A stop ends nothing while the controller still compiles a script, which begins afterwards. `before`: no
/// program ran.
Status MotionStopper::stop_script(const MotionTracker::View & before)
{
  const bool begun = activities_.script_compiled();
  Status stopped = request_program_stop(true);
  if (stopped && !begun && script_begins(before)) {
    stopped = request_program_stop(true);
  }
  if (!stopped) {
    return stopped;
  }
  const std::uint64_t sequence = tracker_.view().sequence + sample_delay;
  const bool ended = wait_for(program_stop_timeout, [&](const Sample & sample) {
    return sample.sequence >= sequence && tracker_.view().sequence >= sample.sequence &&
           sample.runtime_state == RuntimeState::stopped;  // not paused
  });
  ended_programs_ += tracker_.view().program != before.program ? 1 : 0;
  return ended ? Status() : failure(ErrorCode::timeout, "the script was stopped, but has not ended");
}

Status MotionStopper::wait_for_program_end(std::uint32_t program, double timeout)
{
  const bool ended = wait_for(timeout, [&](const Sample & sample) {
    return tracker_.view().program != program || !sample.is_program_running();
  });
  if (!ended) {
    return failure(ErrorCode::timeout, "the program was stopped, but has not ended");
  }
  ++ended_programs_;
  return {};
}

Status MotionStopper::stop_by_watchdog(const StopOptions & options)
{
  const auto before = tracker_.view();
  interfaces_.close_control();
  const double frequency = watchdog_frequency();
  if (frequency == 0.0) {
    return failure(ErrorCode::not_supported, "the program has no watchdog (watchdog_frequency: 0)");
  }
  const bool begins = !before.program_running && script_begins(before);
  const auto shown = Clock::now() + max_skew;  // by the samples, which may be later than what has told it
  // Until its end, the program may move the arm again.
  const bool ended = wait_for(program_stop_timeout + 1.0 / frequency, [&](const Sample & sample) {
    const auto view = tracker_.view();
    const bool has_shown = !begins || view.program != before.program || Clock::now() > shown;
    return has_shown && view.sequence >= sample.sequence && sample.runtime_state == RuntimeState::stopped;
  });
  if (!ended) {
    return failure(ErrorCode::timeout, "the watchdog of the program has not ended it");
  }
  ended_programs_ += tracker_.view().program != before.program ? 1 : 0;
  return wait_for_standstill(program_stop_timeout, options)
             ? Status()
             : failure(ErrorCode::timeout, "the arm moves although the watchdog has ended its program");
}

double MotionStopper::watchdog_frequency() const
{
  return activities_.now().contains(Activity::script) ? options_.watchdog_frequency
                                                      : interfaces_.watchdog_frequency();
}

bool MotionStopper::has_given_up_program() const
{
  const auto view = tracker_.view();
  return view.program_running && active_program_ == view.program && !interfaces_.control_interface();
}

double MotionStopper::cycle_time() const
{
  return 1.0 / state_.version().value_or(ControllerVersion{.major = 5}).frequency();
}

}  // namespace ur_ros_rtde
