#include "program/execution/extension_runner.hpp"

#include <fmt/format.h>
#include <ur_rtde/rtde_io_interface.h>

#include <utility>

#include "motion/motion_blocker.hpp"
#include "state/wait_until.hpp"
#include "ur_ros_rtde_robot/connection/text.hpp"
#include "ur_ros_rtde_robot/script/extension_registers.hpp"

namespace ur_ros_rtde {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr int trigger_register = 18;
constexpr std::size_t acknowledgement = 18 - 12;  // in Sample::output_double_registers
constexpr milliseconds acknowledgement_limit(1000);
constexpr milliseconds stop_limit(3000);
constexpr milliseconds max_latency(30);     // until the samples reflect a change of the trigger
constexpr milliseconds message_limit(300);  // from the end of the program to the error message
constexpr int lines_before_extensions = 1;  // `def rtde_control():`

}  // namespace

struct ExtensionRunner::Run {
  std::string name;
  int id;
  PrimaryConnection primary;
  // Of MotionTracker::View at the begin.
  std::uint32_t program;
  std::uint32_t link;
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

/// Calls `write` with the locked IO interface. `what` names the value in the error.
template <class Write>
Status ExtensionRunner::write_register(const std::string & what, Write write)
{
  try {
    const auto io = interfaces_.io();
    if (io && write(*io->hold())) {
      return {};
    }
    return failure(ErrorCode::link_lost, fmt::format("{} was not sent", what));
  } catch (const RobotError & error) {
    return tl::unexpected(error.error());
  } catch (const std::exception & error) {
    return failure(ErrorCode::link_lost, fmt::format("{} was not sent: {}", what, printable(error.what())));
  }
}

Status ExtensionRunner::set_input(int index, std::int32_t value)
{
  if (auto ok = check_input(index); !ok) {
    return ok;
  }
  return write_register(fmt::format("input integer register {}", index), [&](ur_rtde::RTDEIOInterface & io) {
    return io.setInputIntRegister(index + register_offset(options_), value);
  });
}

Status ExtensionRunner::set_input(int index, double value)
{
  if (auto ok = check_input(index); !ok) {
    return ok;
  }
  return write_register(fmt::format("input float register {}", index), [&](ur_rtde::RTDEIOInterface & io) {
    return io.setInputDoubleRegister(index + register_offset(options_), value);
  });
}

Status ExtensionRunner::set_trigger(int id)
{
  return write_register("the trigger of the extension", [&](ur_rtde::RTDEIOInterface & io) {
    return io.setInputDoubleRegister(trigger_register + register_offset(options_), id);
  });
}

bool ExtensionRunner::wait_for_acknowledgement(double value) const
{
  return wait_until(state_, acknowledgement_limit, [value](const Sample & sample) {
    return sample.sequence != 0 && sample.output_double_registers[acknowledgement] == value;
  });
}

/// Reads from the primary interface why the program has ended while the extension ran.
Status ExtensionRunner::failure_of(Run & run) const
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
  if (sample->output_double_registers[acknowledgement] == run.id) {
    return Status();
  }
  if (options.stop_reason) {
    if (const auto reason = options.stop_reason()) {
      return Status(tl::unexpected(*reason));
    }
  }
  if (Clock::now() - run.begin > options.limit) {
    return failure(ErrorCode::timeout, fmt::format("the extension {} has not ended after {:.1f} s", run.name,
                                                   std::chrono::duration<double>(options.limit).count()));
  }
  return std::nullopt;
}

Status ExtensionRunner::wait_for_result(Run & run, const ExtensionOptions & options)
{
  if (auto triggered = set_trigger(run.id); !triggered) {
    return triggered;
  }
  Sample sample = state_.latest().value_or(Sample{});
  while (true) {
    if (auto result = this->result(run, options)) {
      return *result;
    }
    state_.wait_for_next(sample, milliseconds(20));
  }
}

/// Clears the trigger, so that the control program ends the extension and its motion, and waits for
/// standstill.
bool ExtensionRunner::stop_extension()
{
  set_trigger(0);
  const auto begin = Clock::now();
  return wait_until(state_, stop_limit, [&](const Sample & sample) {
    const auto view = tracker_.view();
    return Clock::now() - begin > max_latency && view.at_rest &&
           (!view.program_running || sample.output_double_registers[acknowledgement] == 0.0);
  });
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
  if (!wait_for_acknowledgement(0.0)) {
    return failure(ErrorCode::not_ready, "the control program has not finished the previous extension");
  }
  auto primary = PrimaryConnection::connect(options_.address, options_.connect_timeout);
  if (!primary) {
    return tl::unexpected(primary.error());
  }
  const auto view = tracker_.view();
  Run run{name, *id, std::move(*primary), view.program, view.link};
  Status result;
  try {
    result = wait_for_result(run, options);
  } catch (...) {  // from ExtensionOptions::stop_reason
    stop_extension();
    throw;
  }
  if (result) {
    if (set_trigger(0)) {
      wait_for_acknowledgement(0.0);
    }
  } else if (!stop_extension()) {
    result.error().message += "; standstill is not confirmed";
  }
  return result;
}

}  // namespace ur_ros_rtde
