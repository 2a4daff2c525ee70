#include "program/extension_runner.hpp"

#include <fmt/format.h>
#include <ur_rtde/rtde_io_interface.h>

#include <utility>

#include "program/motion_blocker.hpp"
#include "ur_ros_rtde_robot/program/extension_registers.hpp"

namespace ur_ros_rtde {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr int trigger_register = 18;
constexpr std::size_t acknowledgement = 18 - 12;  // in Sample::output_double_registers
constexpr milliseconds acknowledgement_limit(1000);
constexpr milliseconds stop_limit(3000);
constexpr milliseconds unseen_limit(30);
constexpr milliseconds message_limit(300);  // for the reason, after the program was seen to end
constexpr int lines_before_extensions = 1;  // of the text: `def rtde_control():`

}  // namespace

struct ExtensionRunner::Run {
  std::string name;
  int id;
  PrimaryLink primary;
  std::uint32_t program;  ///< MotionTracker::View::program when it began
  Clock::time_point begin = Clock::now();
};

ExtensionRunner::ExtensionRunner(const RobotOptions & options, const StateReceiver & state,
                                 const MotionTracker & tracker, RtdeInterfaces & interfaces,
                                 const ControlScripts & scripts)
    : options_(options), state_(state), tracker_(tracker), interfaces_(interfaces), scripts_(scripts)
{
}

Status ExtensionRunner::check_input(int index) const
{
  if (script::free_inputs.contains(index)) {
    return {};
  }
  return failure(ErrorCode::invalid_goal, fmt::format("input register {}: extensions may use {}", index,
                                                      script::to_string(script::free_inputs)));
}

Status ExtensionRunner::set_input(int index, std::int32_t value)
{
  if (auto ok = check_input(index); !ok) {
    return ok;
  }
  const auto io = interfaces_.io();
  if (!io || !(*io)->setInputIntRegister(index + register_offset(options_), value)) {
    return failure(ErrorCode::link_lost, fmt::format("input integer register {} was not sent", index));
  }
  return {};
}

Status ExtensionRunner::set_input(int index, double value)
{
  if (auto ok = check_input(index); !ok) {
    return ok;
  }
  const auto io = interfaces_.io();
  if (!io || !(*io)->setInputDoubleRegister(index + register_offset(options_), value)) {
    return failure(ErrorCode::link_lost, fmt::format("input float register {} was not sent", index));
  }
  return {};
}

Status ExtensionRunner::set_trigger(int id)
{
  const auto io = interfaces_.io();
  if (!io || !(*io)->setInputDoubleRegister(trigger_register + register_offset(options_), id)) {
    return failure(ErrorCode::link_lost, "the trigger of the extension was not sent");
  }
  return {};
}

bool ExtensionRunner::wait_for_acknowledgement(double value, milliseconds limit) const
{
  const auto deadline = Clock::now() + limit;
  Sample sample = state_.latest().value_or(Sample{});
  while (sample.sequence == 0 || sample.output_double_registers[acknowledgement] != value) {
    if (!state_.link().connected || Clock::now() > deadline) {
      return false;
    }
    state_.wait_for_next(sample, milliseconds(20));
  }
  return true;
}

/// The program has ended while the extension ran: the primary interface says why.
Status ExtensionRunner::failed(Run & run) const
{
  const auto version = state_.version().value_or(ControllerVersion{});
  const auto deadline = Clock::now() + message_limit;
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

std::optional<Status> ExtensionRunner::look(Run & run, const ExtensionOptions & options)
{
  const auto link = state_.link();
  const auto sample = state_.latest();
  if (!link.connected || !sample) {
    return failure(ErrorCode::link_lost, link.error.message);
  }
  if (const auto condition = motion_blocker(*sample)) {
    return Status(tl::unexpected(*condition));
  }
  const auto view = tracker_.view();
  if (view.program != run.program || !view.program_running) {
    return failed(run);
  }
  if (sample->output_double_registers[acknowledgement] == run.id) {
    return Status();
  }
  if (options.stop_reason) {
    if (const auto why = options.stop_reason()) {
      return Status(tl::unexpected(*why));
    }
  }
  if (Clock::now() - run.begin > options.limit) {
    return failure(ErrorCode::timeout, fmt::format("the extension {} has not ended after {:.1f} s", run.name,
                                                   std::chrono::duration<double>(options.limit).count()));
  }
  return std::nullopt;
}

/// The trigger has been taken back: the control program ends the extension, and the arm's motion with it, and
/// says so, if it still runs.
void ExtensionRunner::end_early(Error & why)
{
  const auto begin = Clock::now();
  const auto deadline = begin + stop_limit;
  Sample sample = state_.latest().value_or(Sample{});
  const auto ended = [&] {
    const bool seen = Clock::now() - begin > unseen_limit;  // what comes before may be older than the trigger
    const bool program = tracker_.view().program_running;
    return seen && tracker_.view().at_rest &&
           (!program || sample.output_double_registers[acknowledgement] == 0.0);
  };
  while (!ended()) {
    if (!state_.link().connected || Clock::now() > deadline) {
      why.message += "; standstill is not confirmed";
      return;
    }
    state_.wait_for_next(sample, milliseconds(20));
  }
}

Status ExtensionRunner::run(const std::string & name, const ExtensionOptions & options)
{
  const std::unique_lock one_at_a_time(running_, std::try_to_lock);
  if (!one_at_a_time) {
    return failure(ErrorCode::busy, "another extension runs: wait for its end, or cancel it");
  }
  const auto id = scripts_.id(name);
  if (!id) {
    return tl::unexpected(id.error());
  }
  if (!wait_for_acknowledgement(0.0, acknowledgement_limit)) {
    return failure(ErrorCode::not_ready, "the control program is still busy with the extension before");
  }
  auto primary = PrimaryLink::connect(options_.address, options_.connect_timeout);
  if (!primary) {
    return tl::unexpected(primary.error());
  }
  Run run{name, *id, std::move(*primary), tracker_.view().program};
  std::optional<Status> end;
  if (const auto set = set_trigger(*id); !set) {
    end = set;
  }
  Sample sample = state_.latest().value_or(Sample{});
  while (!end && !(end = look(run, options))) {
    state_.wait_for_next(sample, milliseconds(20));
  }
  const Status taken_back = set_trigger(0);
  if (!*end) {
    end_early(end->error());
  } else if (taken_back) {
    wait_for_acknowledgement(0.0, acknowledgement_limit);
  }
  return *end;
}

}  // namespace ur_ros_rtde
