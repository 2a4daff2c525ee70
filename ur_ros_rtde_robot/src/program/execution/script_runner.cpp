#include "program/execution/script_runner.hpp"

#include <fmt/format.h>

#include <random>
#include <utility>

#include "connection/primary_connection.hpp"
#include "motion/motion_stopper.hpp"
#include "program/execution/script_monitor.hpp"
#include "script/program.hpp"
#include "state/wait_until.hpp"

namespace ur_ros_rtde {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds yield_limit(5000);
constexpr milliseconds resume_limit(5000);
constexpr milliseconds program_end_limit(2000);
constexpr milliseconds standstill_limit(500);
constexpr milliseconds longest_secondary(10'000);

ScriptReport refused(Error error)
{
  ScriptReport report;
  report.error = std::move(error);
  return report;
}

ScriptReport refused(const script::Fault & fault)
{
  ScriptReport report =
      refused(Error{ErrorCode::invalid_goal,
                    fault.line > 0 ? fmt::format("line {}: {}", fault.line, fault.message) : fault.message});
  report.line = fault.line;
  return report;
}

std::optional<Error> check(const ScriptOptions & options)
{
  if (options.limit < milliseconds(1)) {
    return Error{ErrorCode::invalid_goal,
                 fmt::format("limit is {} ms: it must be 1 ms or more", options.limit.count())};
  }
  if (options.kind == ScriptKind::secondary && options.limit > longest_secondary) {
    return Error{ErrorCode::invalid_goal,
                 fmt::format("limit is {} ms: a secondary program must end within {} ms",
                             options.limit.count(), longest_secondary.count())};
  }
  return std::nullopt;
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
    if (monitor_.replaced()) {
      manager_.resume_after_replacement(resume_limit);
    } else {
      manager_.resume(resume_limit);
    }
  }
  ResumeGuard(const ResumeGuard &) = delete;
  ResumeGuard & operator=(const ResumeGuard &) = delete;

 private:
  ControlProgramManager & manager_;
  const ScriptMonitor & monitor_;
};

}  // namespace

ScriptRunner::ScriptRunner(const RobotOptions & options, const StateReceiver & state,
                           const MotionTracker & tracker, RtdeInterfaces & interfaces,
                           ControlProgramManager & manager)
    : options_(options),
      state_(state),
      tracker_(tracker),
      interfaces_(interfaces),
      manager_(manager),
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

bool ScriptRunner::wait_for_program_end() const
{
  return wait_until(state_, program_end_limit, [this](const Sample & sample) {
    return tracker_.view().at_rest && sample.runtime_state == RuntimeState::stopped;
  });
}

Status ScriptRunner::stop() const
{
  auto stopped = stop_program(options_.address, milliseconds(500));
  if (stopped && wait_for_program_end()) {
    return {};
  }
  interfaces_.close_control();  // ends the heartbeat, so that the watchdog stops the program
  if (wait_for_program_end()) {
    return {};
  }
  return stopped ? failure(ErrorCode::timeout, "the program does not end") : stopped;
}

ScriptReport ScriptRunner::run(const std::string & script, const ScriptOptions & options)
{
  if (auto error = check(options)) {
    return refused(std::move(*error));
  }
  const bool secondary = options.kind == ScriptKind::secondary;
  if (!secondary && options_.control_mode == ControlMode::control_urcap) {
    return refused(Error{ErrorCode::not_supported,
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
    return refused(program.error());
  }
  auto primary = PrimaryConnection::connect(options_.address, options_.connect_timeout);
  if (!primary) {
    return refused(primary.error());
  }
  ScriptMonitor monitor(std::move(*primary), state_, markers, options);
  if (secondary) {
    monitor.run(*program);
    return monitor.report();
  }
  return run_program(*program, monitor);
}

ScriptReport ScriptRunner::run_program(const script::Program & program, ScriptMonitor & monitor)
{
  const bool at_rest =
      wait_until(state_, standstill_limit, [this](const Sample &) { return tracker_.view().at_rest; });
  if (!at_rest) {
    return refused(Error{ErrorCode::busy, "the arm moves: a script begins when it stands still"});
  }
  if (const auto yielded = manager_.yield(yield_limit); !yielded) {
    return refused(yielded.error());
  }
  const ResumeGuard resume(manager_, monitor);
  try {
    monitor.run(program);
  } catch (...) {
    stop();
    throw;
  }
  ScriptReport report = monitor.report();
  if (monitor.may_be_running() && state_.link().connected) {
    if (const auto stopped = stop(); !stopped) {
      report.error.message += fmt::format("; standstill is not confirmed: {}", stopped.error().message);
    }
  }
  return report;
}

}  // namespace ur_ros_rtde
