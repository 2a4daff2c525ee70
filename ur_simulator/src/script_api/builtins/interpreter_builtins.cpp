#include "script_api/interpreter_mode.hpp"
#include "script_api/motion_operation.hpp"

// Interpreter mode: the program executes statements that clients send.

namespace ur_simulator::script_api {

namespace {

/// interpreter_mode(): lasts until it is ended by a statement or by another thread.
class InterpreterOperation final : public urscript::PendingCall {
 public:
  explicit InterpreterOperation(RobotContextPtr robot) : robot_(std::move(robot)) {}

  tl::expected<std::optional<Value>, std::string> poll(CallContext &) override
  {
    return mode().cycle() ? std::nullopt : std::optional(Value());
  }
  std::optional<std::uint32_t> next_function() override { return mode().next_function(); }
  void cancel() override { mode().cancel(); }

 private:
  InterpreterMode & mode() { return *robot_->access.interpreter_mode; }

  RobotContextPtr robot_;
};

Outcome interpreter_mode(const RobotContextPtr & robot, CallContext & context, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const InterpreterMode::Options options{reader.boolean(0, "clearQueueOnEnter"),
                                         reader.boolean(1, "clearOnEnd")};
  if (!reader) {
    return reader.failure();
  }
  InterpreterMode & mode = *robot->access.interpreter_mode;
  if (!context.main_thread || context.secondary) {
    return Failure{"interpreter mode can only be entered in the main thread of a program"};
  }
  if (mode.active()) {
    return Failure{"the program is in interpreter mode already"};
  }
  mode.begin(context.program, context.extension, options);
  return std::make_unique<InterpreterOperation>(robot);
}

void abort_move(RobotContext & robot)
{
  if (robot.motion_owner != nullptr) {
    robot.motion_owner->abort();
  }
}

}  // namespace

void add_interpreter_builtins(Library & library, const RobotContextPtr & robot)
{
  library.add({"interpreter_mode",
               {{"clearQueueOnEnter", Value(true)}, {"clearOnEnd", Value(true)}},
               0,
               [robot](CallContext & context, Arguments arguments) {
                 return interpreter_mode(robot, context, arguments);
               }});
  add_robot_builtin(library, robot, "end_interpreter", {}, 0,
                    [](RobotContext & context, Arguments) -> Outcome {
                      context.access.interpreter_mode->request_end();
                      return Value();
                    });
  add_robot_builtin(library, robot, "clear_interpreter", {}, 0,
                    [](RobotContext & context, Arguments) -> Outcome {
                      InterpreterMode & mode = *context.access.interpreter_mode;
                      if (!mode.active()) {
                        return Failure{"the program is not in interpreter mode"};
                      }
                      mode.request_clear();
                      return Value();
                    });
  robot->access.interpreter_mode->set_abort_handler([weak = std::weak_ptr(robot)] {
    if (const auto context = weak.lock()) {
      abort_move(*context);
    }
  });
}

}  // namespace ur_simulator::script_api
