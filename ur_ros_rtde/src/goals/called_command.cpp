#include "ur_ros_rtde/detail/called_command.hpp"

#include <fmt/format.h>

#include "ur_ros_rtde/detail/guarded.hpp"
#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde {
namespace {

/// Of commands that call commands. More than anyone needs: a command that calls itself gets there.
constexpr int max_depth = 8;

/// The goal of a command that uses `own` may execute one that uses `other`.
bool covers(Resource own, Resource other)
{
  return !moves_arm(other) || own == other || (own == Resource::motion && other == Resource::mode);
}

/// If the goal has to end during a call, the arm is stopped as the called command asks.
class StopOptionsOfCall {
 public:
  StopOptionsOfCall(const RunContext & context, const StopOptions & options)
      : context_(context), before_(context.exchange_stop_options(options))
  {
  }
  ~StopOptionsOfCall() { context_.exchange_stop_options(before_); }
  StopOptionsOfCall(const StopOptionsOfCall &) = delete;
  StopOptionsOfCall & operator=(const StopOptionsOfCall &) = delete;

 private:
  const RunContext & context_;
  const StopOptions before_;
};

}  // namespace

Error not_callable(const std::string & command, bool exists)
{
  return {ErrorCode::not_supported,
          exists ? fmt::format("{} cannot be called: its action has another type", command)
                 : fmt::format("{} cannot be called: command_server has no such command; see its log, and "
                               "the parameters plugins and plugins_blacklist",
                               command)};
}

CommandPlugin * Run::find_command(const std::string & name) const
{
  return context_.command != nullptr
             ? context_.command->host.find_command(name, context_.stop_request->token())
             : nullptr;
}

Status Run::may_execute(const CalledCommand & called) const
{
  if (auto why = stop_reason()) {
    return tl::unexpected(*std::move(why));
  }
  if (context_.depth >= max_depth) {
    return failure(ErrorCode::not_supported,
                   fmt::format("more than {} commands call each other: does it call itself?", max_depth));
  }
  const CommandDescription & wanted = called.description;
  const Resource own = context_.command->traits.resource;
  if (wanted.traits.preempts_all || wanted.traits.allowed_in_any_state) {
    return failure(ErrorCode::not_supported, "a command that stops or switches the robot cannot be called");
  }
  if (!covers(own, wanted.traits.resource)) {
    return failure(ErrorCode::not_supported,
                   fmt::format("it needs the resource {}, and the command that calls it has {}: see traits()",
                               to_string(wanted.traits.resource), to_string(own)));
  }
  if (wanted.traits.excludes_force_mode) {
    Claim claim;
    claim.resource = wanted.traits.resource;
    claim.owner = wanted.action;
    claim.excludes_force_mode = true;
    if (Status possible = robot().may_use(claim); !possible) {
      return possible;
    }
  }
  if (wanted.traits.resource != Resource::none) {
    if (Status current = wanted.executions->are_current(wanted.action); !current) {
      return current;
    }
  }
  return wanted.is_extension ? robot().has_extension(wanted.plugin) : Status();
}

Outcome Run::execute(const CalledCommand & called)
{
  const CommandDescription & wanted = called.description;
  const Activities active_before = robot().activities() & outlasting_modes;
  std::optional<StopOptionsOfCall> stop_options;
  const Outcome outcome = guarded(*context_.stop_request, [&]() -> Outcome {
    if (Status resolved = called.resolve_frame(context_.stop_request->token()); !resolved) {
      return resolved;
    }
    Check check(&context_.robot, [&] { return may_execute(called); });
    called.check(check);
    if (Status possible = check.ready().ask(context_.robot); !possible) {
      return possible;
    }
    if (wanted.needs_motion()) {
      stop_options.emplace(context_, called.stop_options());
    }
    Lease io;
    if (wanted.traits.resource == Resource::io && context_.command->traits.resource != Resource::io) {
      Claim claim;
      claim.resource = Resource::io;
      claim.owner = context_.command->action;
      auto lease = context_.robot.acquire(std::move(claim));
      if (!lease) {
        return lease.error();
      }
      io = std::move(*lease);
    }
    RunContext context = context_;
    context.command = &wanted;
    ++context.depth;
    context.lease = wanted.needs_motion() ? context_.lease : nullptr;
    context.publish_feedback = [this](const void *) { publish_feedback_if_due(); };
    return called.run(context);
  });
  const Outcome settled = settle(called, outcome, active_before);
  return settled || stop_reason()
             ? settled
             : Outcome::failure(settled.code(), fmt::format("{}: {}", wanted.plugin, settled.message()));
}

Outcome Run::settle(const CalledCommand & called, const Outcome & outcome, Activities active_before)
{
  if (context_.lease == nullptr || !called.description.needs_motion()) {
    return outcome;
  }
  StopOptions options = called.stop_options();
  options.keep = active_before;
  if (outcome && called.description.traits.leaves_mode_active) {
    options.keep = options.keep | outlasting_modes;
  }
  if (const Status stopped = stop_except_kept(options); !stopped && outcome) {
    return standstill_not_confirmed(stopped.error());
  }
  return outcome;
}

}  // namespace ur_ros_rtde
