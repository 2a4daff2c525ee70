#include "program/execution/script_runner.hpp"

#include <fmt/format.h>

#include <random>
#include <tuple>
#include <utility>

#include "connection/primary_connection.hpp"
#include "program/execution/script_monitor.hpp"
#include "program/program_status.hpp"
#include "script/program.hpp"
#include "state/wait_until.hpp"

namespace ur_ros_rtde {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds yield_timeout(5000);
constexpr milliseconds resume_timeout(5000);
constexpr milliseconds standstill_timeout(500);
constexpr milliseconds longest_secondary(10'000);

ScriptReport rejected(Error error)
{
  ScriptReport report;
  report.error = std::move(error);
  return report;
}

ScriptReport rejected(const script::Fault & fault)
{
  ScriptReport report =
      rejected(Error{ErrorCode::invalid_goal,
                     fault.line > 0 ? fmt::format("line {}: {}", fault.line, fault.message) : fault.message});
  report.line = fault.line;
  return report;
}

std::optional<Error> check(const ScriptOptions & options)
{
  if (options.timeout < milliseconds(1)) {
    return Error{ErrorCode::invalid_goal,
                 fmt::format("timeout is {} ms: it must be 1 ms or more", options.timeout.count())};
  }
  if (options.kind == ScriptKind::secondary && options.timeout > longest_secondary) {
    return Error{ErrorCode::invalid_goal,
                 fmt::format("timeout is {} ms: a secondary program must end within {} ms",
                             options.timeout.count(), longest_secondary.count())};
  }
  return std::nullopt;
}

Error program_ended()
{
  return {ErrorCode::program_stopped, "the control program ended before the script was sent"};
}

/// Resumes the control program on destruction.
class ResumeGuard {
 public:
  ResumeGuard(ControlProgramManager & manager, const ScriptMonitor & monitor)
      : manager_(manager), monitor_(monitor)
  {
  }
  ~ResumeGuard()
  {
    // The status of the robot tells why the control program does not run, if it does not.
    std::ignore = monitor_.replaced() ? manager_.resume_after_replacement(resume_timeout)
                                      : manager_.resume(resume_timeout);
  }
  ResumeGuard(const ResumeGuard &) = delete;
  ResumeGuard & operator=(const ResumeGuard &) = delete;

 private:
  ControlProgramManager & manager_;
  const ScriptMonitor & monitor_;
};

}  // namespace

ScriptRunner::ScriptRunner(const RobotOptions & options, const StateReceiver & state,
                           const MotionTracker & tracker, StartedActivities & activities,
                           MotionStopper & stopper, ControlProgramManager & manager,
                           std::function<Generation()> generation, std::function<bool()> has_lost_control)
    : options_(options),
      state_(state),
      tracker_(tracker),
      activities_(activities),
      stopper_(stopper),
      manager_(manager),
      generation_(std::move(generation)),
      has_lost_control_(std::move(has_lost_control)),
      next_id_(std::random_device()())
{
}

/// The script gets the watchdog of the control program.
std::string ScriptRunner::preamble() const
{
  if (options_.watchdog_frequency == 0.0) {
    return {};
  }
  return fmt::format("  rtde_set_watchdog(\"input_int_register_{}\", {}, \"stop\")",
                     register_offset(options_), options_.watchdog_frequency);
}

ScriptReport ScriptRunner::run(Permit * holder, const std::string & script, const ScriptOptions & options)
{
  if (auto error = check(options)) {
    return rejected(std::move(*error));
  }
  const bool secondary = options.kind == ScriptKind::secondary;
  if (!secondary && holder == nullptr) {
    return rejected(Error{ErrorCode::exception, "a script of kind `program` needs Resource::script"});
  }
  if (!secondary && options_.control_mode == ControlMode::control_urcap) {
    return rejected(Error{ErrorCode::not_supported,
                          "not with control_mode control_urcap: the script would end the program of the "
                          "robot, which only the operator can restart. Use control_mode upload, or "
                          "a script of kind `sec`"});
  }
  const auto id = next_id_++;
  const ScriptMonitor::Markers markers{fmt::format("ur_ros_rtde: script {:08x} begins", id),
                                       fmt::format("ur_ros_rtde: script {:08x} ends", id)};
  const auto program =
      script::make_program(script, {secondary, markers.begin, markers.end, secondary ? "" : preamble()});
  if (!program) {
    return rejected(program.error());
  }
  auto primary = PrimaryConnection::connect(options_.address, options_.connect_timeout);
  if (!primary) {
    return rejected(primary.error());
  }
  ScriptMonitor monitor(std::move(*primary), state_, markers, options);
  if (secondary) {
    const std::stop_callback fence(options.stop, [&monitor] { monitor.fence(); });
    monitor.run(*program);
    return monitor.report();
  }
  return run_program(*holder, *program, monitor);
}

ScriptReport ScriptRunner::run_program(Permit & holder, const script::Program & program,
                                       ScriptMonitor & monitor)
{
  const bool at_rest =
      wait_until(state_, standstill_timeout, [this](const Sample &) { return tracker_.view().at_rest; });
  if (!at_rest) {
    return rejected(Error{ErrorCode::busy, "the arm moves: a script begins when it is at rest"});
  }
  const Generation begin = holder.generation();
  if (generation_() != begin) {
    return rejected(program_ended());
  }
  if (const auto yielded = manager_.yield(yield_timeout); !yielded) {
    return rejected(yielded.error());
  }
  ++ended_programs_;
  const ResumeGuard resume(manager_, monitor);
  // The goal is that of one control program, which has yielded; not that of another one, which was started in
  // between.
  if (const Generation now = generation_(); now.link != begin.link || now.starts != begin.starts + 1) {
    return rejected(program_ended());
  }
  const auto before = tracker_.view().program;
  ScriptReport report = monitor_program(holder, program, monitor);
  if (report.end == ScriptEnd::finished) {
    // A script of one cycle leaves no trace in the samples; the tracker counts a pause as an end.
    const auto end = std::chrono::steady_clock::now();
    wait_until(state_, standstill_timeout, [&](const Sample & sample) {
      const auto view = tracker_.view();
      return view.sequence >= sample.sequence && (view.program != before || sample.received > end);
    });
    ended_programs_ += tracker_.view().program - before;
  }
  if (holder.revoked()) {  // the stop under way must not meet the control program
    stopper_.end(holder, {}).wait();
  }
  return report;
}

void ScriptRunner::explain(ScriptReport & report) const
{
  const bool was_ended = report.end == ScriptEnd::runtime_error || report.end == ScriptEnd::stopped;
  const double frequency = options_.watchdog_frequency;
  if (!was_ended || frequency == 0.0) {
    return;
  }
  if (has_lost_control_()) {
    report.error = {ErrorCode::link_lost,
                    fmt::format("the connection that feeds the watchdog of the script was lost; {}",
                                report.error.message)};
  } else if (const double gap = tracker_.view().gap; gap > 1.0 / frequency) {
    report.error = stopped_by_watchdog("the script", gap, frequency, report.error.message);
  }
}

ScriptReport ScriptRunner::monitor_program(Permit & holder, const script::Program & program,
                                           ScriptMonitor & monitor)
{
  StartedActivities::Script activity(activities_, [&monitor] { monitor.fence(); });
  monitor.on_compiled = [&activity] { activity.set_compiled(); };
  if (auto why = holder.revoked()) {  // a later stop finds the activity
    return rejected(*std::move(why));
  }
  try {
    monitor.run(program);
  } catch (...) {  // from a callback
    stopper_.end(holder, {}).wait();
    throw;
  }
  ScriptReport report = monitor.report();
  explain(report);
  if (monitor.may_be_running()) {
    const auto stop = stopper_.end(holder, {});
    // The stop waits for a script that the controller still compiles.
    monitor.read_until_compiled([&] { return stop.wait_for(milliseconds(0)) == std::future_status::ready; });
    if (const auto stopped = stop.get(); !stopped) {
      report.error = standstill_not_confirmed(report.error, stopped.error());
    }
  }
  return report;
}

}  // namespace ur_ros_rtde
