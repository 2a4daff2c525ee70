#include "program/execution/extension_runner.hpp"

#include <fmt/format.h>

#include <utility>

#include "motion/motion_blocker.hpp"
#include "state/wait_until.hpp"
#include "ur_ros_rtde_robot/connection/text.hpp"

namespace ur_ros_rtde {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds acknowledgement_timeout(1000);
/// For the IO connection to be opened again. That ends the extension more gently than the next means of a
/// stop.
constexpr milliseconds reconnection_timeout(1000);
constexpr milliseconds message_timeout(300);  // from the end of the program to the error message
constexpr int lines_before_extensions = 1;    // `def rtde_control():`

}  // namespace

struct ExtensionRunner::Run {
  std::string name;
  int id;
  PrimaryConnection primary;
  // Of MotionTracker::View at the begin.
  std::uint32_t program;
  std::uint32_t link;
  std::uint32_t io_starts;  ///< InputRegisters::Connection::starts
  InputRegisters::Permission permission;
  bool begun = false;
  Clock::time_point begin = Clock::now();
  std::optional<double> controller_begin = std::nullopt;  ///< s, of the first sample
  std::optional<Clock::time_point> disconnected_since = std::nullopt;
};

bool ExtensionRunner::wait_for_acknowledgement(double value) const
{
  return wait_until(state_, acknowledgement_timeout, [value](const Sample & sample) {
    return sample.sequence != 0 && sample.extension_acknowledgement() == value;
  });
}

/// Reads from the primary interface why the program has ended while the extension ran.
Status ExtensionRunner::failure_of(Run & run) const
{
  const auto version = state_.version().value_or(ControllerVersion{});
  const auto deadline = Clock::now() + message_timeout;
  while (Clock::now() < deadline) {
    const auto message = run.primary.next(milliseconds(50));
    if (!message) {
      break;
    }
    if (*message && (*message)->kind == PrimaryMessage::Kind::error) {
      const std::string where = scripts_.place(version, (*message)->line - lines_before_extensions);
      return failure(ErrorCode::rejected_by_robot,
                     fmt::format("{} failed: {}", where.empty() ? "the extension " + run.name : where,
                                 (*message)->text));
    }
  }
  return failure(ErrorCode::program_stopped,
                 fmt::format("the control program was stopped while the extension {} ran", run.name));
}

/// Something else than this runner has cleared the trigger: a stop, or the IO interface when it was connected
/// again.
Status ExtensionRunner::trigger_lost(const Run & run) const
{
  if (const auto permitted = run.permission(); !permitted) {
    return tl::unexpected(permitted.error());
  }
  return failure(
      ErrorCode::link_lost,
      fmt::format("the IO connection was lost during the extension {}: send the goal again", run.name));
}

void ExtensionRunner::update(Run & run, const Sample & sample) const
{
  run.begun = run.begun || sample.extension_acknowledgement() == -run.id;
  run.controller_begin = run.controller_begin.value_or(sample.controller_time);
  if (registers_.connection().is_open) {
    run.disconnected_since.reset();
  } else {
    run.disconnected_since = run.disconnected_since.value_or(Clock::now());
  }
}

bool ExtensionRunner::has_lost_connection(const Run & run) const
{
  return (!run.begun && registers_.connection().starts != run.io_starts) ||
         (run.disconnected_since && Clock::now() - *run.disconnected_since > reconnection_timeout);
}

/// By both clocks: the controller may be slow, and the samples may be delayed.
bool ExtensionRunner::is_ignored(const Run & run, const Sample & sample)
{
  const std::chrono::duration<double> timeout(acknowledgement_timeout);
  return !run.begun && Clock::now() - run.begin > acknowledgement_timeout &&
         sample.controller_time - *run.controller_begin > timeout.count();
}

std::optional<Status> ExtensionRunner::result(Run & run, const ExtensionOptions & options) const
{
  const auto link = state_.link();
  const auto sample = state_.latest();
  if (!link.connected || !sample) {
    return failure(ErrorCode::link_lost, link.error.message);
  }
  if (const auto blocker = motion_blocker(*sample)) {
    return Status(tl::unexpected(*blocker));
  }
  const auto view = tracker_.view();
  if (view.link != run.link) {
    return failure(ErrorCode::link_lost, connection_replaced);
  }
  if (view.program != run.program || !view.program_running) {
    return failure_of(run);
  }
  const double acknowledgement = sample->extension_acknowledgement();
  if (acknowledgement == run.id) {
    return Status();
  }
  update(run, *sample);
  if (options.stop_reason) {
    if (const auto reason = options.stop_reason()) {  // it may have seen the end of the program first
      return reason->code == ErrorCode::program_stopped ? failure_of(run) : Status(tl::unexpected(*reason));
    }
  }
  if ((run.begun && acknowledgement == 0.0) || has_lost_connection(run)) {
    return trigger_lost(run);
  }
  if (is_ignored(run, *sample)) {
    return failure(
        ErrorCode::timeout,
        fmt::format(
            "the control program has not begun the extension {} within {:.1f} s: its trigger was lost, "
            "or a blocking command occupies the program",
            run.name, std::chrono::duration<double>(acknowledgement_timeout).count()));
  }
  if (Clock::now() - run.begin > options.timeout) {
    return failure(ErrorCode::timeout, fmt::format("the extension {} has not ended after {:.1f} s", run.name,
                                                   std::chrono::duration<double>(options.timeout).count()));
  }
  return std::nullopt;
}

Status ExtensionRunner::wait_for_result(Run & run, const ExtensionOptions & options) const
{
  Sample sample = state_.latest().value_or(Sample{});
  while (true) {
    if (auto result = this->result(run, options)) {
      return *result;
    }
    state_.wait_for_next(sample, milliseconds(20));
  }
}

Status ExtensionRunner::run(const std::string & name, const ExtensionOptions & options,
                            const InputRegisters::Permission & permission)
{
  const std::unique_lock one_at_a_time(running_, std::try_to_lock);
  if (!one_at_a_time) {
    return failure(ErrorCode::busy, "another extension runs: wait for its end, or cancel it");
  }
  const auto id = scripts_.id(name);
  if (!id) {
    return tl::unexpected(id.error());
  }
  // A trigger that was not cleared when the previous extension ended would prevent this one.
  if (Status cleared = registers_.set_trigger(0, {}); !cleared) {
    return cleared;
  }
  if (!wait_for_acknowledgement(0.0)) {
    return failure(ErrorCode::not_ready, "the control program has not finished the previous extension");
  }
  auto primary = PrimaryConnection::connect(options_.address, options_.connect_timeout);
  if (!primary) {
    return tl::unexpected(primary.error());
  }
  const auto view = tracker_.view();
  const auto connection = registers_.connection();
  Run run{name, *id, std::move(*primary), view.program, view.link, connection.starts, permission};
  if (Status triggered = registers_.set_trigger(run.id, permission); !triggered) {
    return triggered;
  }
  if (Status ended = wait_for_result(run, options); !ended) {
    return ended;
  }
  if (Status cleared = registers_.set_trigger(0, {}); !cleared) {
    return cleared;
  }
  if (!wait_for_acknowledgement(0.0)) {
    return failure(
        ErrorCode::timeout,
        fmt::format("the control program does not end the extension {}, which has finished", name));
  }
  return {};
}

}  // namespace ur_ros_rtde
