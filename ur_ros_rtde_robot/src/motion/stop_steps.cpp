// What a stop does, step by step, and when it is done. Runs on the stopper's thread.
#include <fmt/format.h>

#include <algorithm>

#include "connection/dashboard_request.hpp"
#include "motion/motion_blocker.hpp"
#include "motion/motion_stopper.hpp"

namespace ur_ros_rtde {
namespace {

/// The robot stops the arm without being told to.
bool stops_by_itself(const Sample & sample, Activities started)
{
  return motion_blocker(sample) || (!sample.is_program_running() && !started.contains(Activity::script));
}

}  // namespace

Expected<StopReport> MotionStopper::execute(const StopOptions & options)
{
  auto report = execute_once(options);
  const bool is_back = !report && report.error().code == ErrorCode::link_lost && state_.link().connected;
  // The connection can tell what stops the arm, or whether it has stopped.
  return is_back ? execute_once(options) : report;
}

Expected<StopReport> MotionStopper::execute_once(const StopOptions & options)
{
  const auto first = tracker_.view();
  if (first.program_running && !(first.at_rest && activities_.now().empty())) {
    active_program_ = first.program;
  }
  const auto report = [&](const Expected<StopMeans> & means) -> Expected<StopReport> {
    if (!means) {
      return tl::unexpected(means.error());
    }
    return StopReport{*means, tracker_.view().controller_time - first.controller_time};
  };
  if (!state_.link().connected) {
    return stop_without_rtde();
  }
  const auto at_rest = [&](StopMeans means) {
    const auto settled = settle(means, options);
    return settled || state_.link().connected ? report(settled) : stop_without_rtde();
  };
  if (finds_foreign_program(options)) {
    const auto ended = end_foreign_program(options);
    return ended || state_.link().connected ? report(ended) : stop_without_rtde();
  }
  if (!state_.link().connected) {
    return stop_without_rtde();  // lost since
  }
  if (is_done(options)) {
    return at_rest(StopMeans::nothing_moved);
  }
  std::string problems;
  for (const Means & next : means()) {
    const auto sample = state_.latest();
    if (!state_.link().connected || !sample) {
      return stop_without_rtde();
    }
    const Activities started = activities_.now();
    if (stops_by_itself(*sample, started) && wait_for_standstill(program_stop_timeout, options)) {
      return at_rest(StopMeans::stopped_by_robot);
    }
    const Status stopped = (this->*next.attempt)(options);
    if (stopped) {
      return report(next.means);
    }
    if (options_changed_) {
      break;  // the caller executes the stop with the new options
    }
    problems += fmt::format("{}{}", problems.empty() ? "" : "; ", stopped.error().message);
  }
  if (!state_.link().connected) {
    return stop_without_rtde();
  }
  return failure(
      ErrorCode::timeout,
      fmt::format("all attempts to stop the arm have failed: use the emergency stop ({})", problems));
}

Expected<StopReport> MotionStopper::stop_without_rtde() const
{
  activities_.fence_script();
  // Its answer is the only report. Without RTDE data, the watchdog ends the program too.
  constexpr std::chrono::seconds answer_timeout(3);
  const Status stopped = stop_program(options_.address, answer_timeout);
  const std::string link = state_.link().error.message;
  if (stopped) {
    return failure(
        ErrorCode::link_lost,
        fmt::format(
            "the program on the robot was stopped through the dashboard server, and nothing shows the "
            "arm: {}",
            link));
  }
  const std::string watchdog =
      watchdog_frequency() > 0.0
          ? fmt::format("the watchdog of its program stops the arm within {:.2g} s",
                        1.0 / watchdog_frequency())
          : std::string("the program has no watchdog (watchdog_frequency: 0): use the emergency stop");
  return failure(ErrorCode::link_lost,
                 fmt::format("cannot tell the robot to stop: {}; dashboard server: {}; {}", link,
                             stopped.error().message, watchdog));
}

Expected<StopMeans> MotionStopper::settle(StopMeans means, const StopOptions & options)
{
  return may_go_on(state_.latest().value_or(Sample{}), activities_.now())
             ? end_program_that_may_go_on(std::max(means, StopMeans::stopped_by_robot), options)
             : means;
}

Expected<StopMeans> MotionStopper::end_program_that_may_go_on(StopMeans means, const StopOptions & options)
{
  if (const Status ended = end_program(options); !ended) {
    return failure(
        ErrorCode::timeout,
        fmt::format("the program has not ended and may move the arm again: stop it on the pendant ({})",
                    ended.error().message));
  }
  return means;
}

Expected<StopMeans> MotionStopper::end_foreign_program(const StopOptions & options)
{
  if (const Status ended = stop_by_dashboard(options); !ended) {
    return failure(ErrorCode::timeout,
                   fmt::format("a program that is not of this driver runs on the robot and may move the arm: "
                               "stop it on the pendant ({})",
                               ended.error().message));
  }
  return StopMeans::program_stopped;
}

bool MotionStopper::finds_foreign_program(const StopOptions & options) const
{
  if (!options.ends_foreign_program) {
    return false;
  }
  if (foreign_program_plays()) {
    return true;
  }
  // Late samples do not show yet what has replaced the control program.
  return is_done(options) && lateness() > 0.0 && wait_for_present() && foreign_program_plays();
}

bool MotionStopper::foreign_program_plays() const
{
  if (!program_.has_foreign_program()) {
    return false;
  }
  const bool plays = state_.latest().value_or(Sample{}).is_program_running();
  return plays || (lateness() > 0.0 && may_play(options_.address));
}

bool MotionStopper::may_go_on(const Sample & sample, Activities started) const
{
  if (started.contains(Activity::script)) {
    return true;  // even if the controller is still compiling it
  }
  const bool has_ended =
      sample.runtime_state == RuntimeState::stopped || sample.runtime_state == RuntimeState::stopping;
  const bool was_interrupted = !sample.is_program_running() && !started.empty();
  return !has_ended && (was_interrupted || program_.has_left_program());
}

Status MotionStopper::end_program(const StopOptions & options)
{
  const auto has_ended = [this](const Sample & sample) {
    return sample.runtime_state == RuntimeState::stopped || !may_go_on(sample, activities_.now());
  };
  Status ended = stop_by_dashboard(options);
  if (ended && !wait_for(program_stop_timeout, has_ended)) {
    ended = failure(ErrorCode::timeout, "the program was stopped, but has not ended");
  }
  if (ended || options_changed_ || !state_.link().connected) {
    return ended;  // interrupted: the caller begins again
  }
  const Status by_watchdog = stop_by_watchdog(options);
  return by_watchdog ? by_watchdog
                     : failure(by_watchdog.error().code,
                               fmt::format("{}; {}", ended.error().message, by_watchdog.error().message));
}

bool MotionStopper::is_done(const StopOptions & options) const
{
  const Activities started = activities_.now();
  if (!started.without(options.keep).empty() || has_given_up_program()) {
    return false;
  }
  const auto view = tracker_.view();
  // A mode that stays on may move the arm.
  return !view.operating() && (view.at_rest || !started.empty());
}

}  // namespace ur_ros_rtde
