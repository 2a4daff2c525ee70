#include "kinematics/inverse_kinematics.hpp"
#include "motion/arm.hpp"
#include "script_api/robot_context.hpp"

namespace ur_simulator::script_api {

namespace {

// singularity_distance() below which get_freedrive_status() returns 1 and 2; not published.
constexpr double singularity_warning_distance = 0.2;
constexpr double singularity_stop_distance = 0.1;

std::array<bool, 6> all_axes()
{
  std::array<bool, 6> axes;
  axes.fill(true);
  return axes;
}

/// The argument `feature`: a pose, "base" or "tool".
Vector6 feature(const RobotContext & robot, ArgumentReader & reader)
{
  if (!reader.given(1)) {
    return Vector6::Zero();
  }
  if (!reader.value(1).is(urscript::Type::string)) {
    return reader.pose(1, "feature");
  }
  const std::string name = reader.string(1, "feature");
  reader.require(name == "base" || name == "tool",
                 fmt::format("feature must be \"base\", \"tool\" or a pose, is \"{}\"", name));
  return name == "tool" ? robot.state().actual_tcp_pose : Vector6(Vector6::Zero());
}

Outcome start_freedrive(RobotContext & robot, const CallContext & context, const std::array<bool, 6> & axes,
                        const Vector6 & frame)
{
  if (context.secondary) {
    return Failure{"a secondary program cannot enter freedrive"};
  }
  if (robot.motion_owner != nullptr) {
    return Failure{"Another thread is already controlling the robot"};
  }
  const StartResult started = robot.access.arm.start_freedrive(axes, frame);
  return started ? Outcome(Value()) : Failure{started.error()};
}

Outcome freedrive_mode(RobotContext & robot, const CallContext & context, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::array<bool, 6> axes = reader.given(0) ? reader.selection(0, "freeAxes") : all_axes();
  const Vector6 frame = feature(robot, reader);
  return reader ? start_freedrive(robot, context, axes, frame) : reader.failure();
}

Outcome teach_mode(RobotContext & robot, const CallContext & context)
{
  return start_freedrive(robot, context, all_axes(), Vector6::Zero());
}

Outcome freedrive_status(RobotContext & robot, Arguments)
{
  const double freedom = singularity_distance(robot.access.model, robot.state().actual.position);
  return Value(freedom < singularity_stop_distance ? 2 : freedom < singularity_warning_distance ? 1 : 0);
}

}  // namespace

void add_freedrive_builtins(Library & library, const RobotContextPtr & robot)
{
  library.add(
      {"freedrive_mode", {"freeAxes", "feature"}, 0, [robot](CallContext & context, Arguments arguments) {
         return freedrive_mode(*robot, context, arguments);
       }});
  for (const char * name : {"teach_mode", "freedrive_mode_no_incorrect_payload_check"}) {
    library.add(
        {name, {}, 0, [robot](CallContext & context, Arguments) { return teach_mode(*robot, context); }});
  }
  for (const char * name : {"end_freedrive_mode", "end_teach_mode"}) {
    library.add({name, {}, 0, [robot](CallContext &, Arguments) -> Outcome {
                   robot->access.arm.end_freedrive();
                   return Value();
                 }});
  }
  add_robot_builtin(library, robot, "get_freedrive_status", {}, 0, freedrive_status);
}

}  // namespace ur_simulator::script_api
