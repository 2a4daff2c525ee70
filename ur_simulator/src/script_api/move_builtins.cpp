#include "script_api/move_target.hpp"

namespace ur_simulator::script_api {

namespace {

MoveOptions move_options(ArgumentReader & in)
{
  return {in.number(1, "a"), in.number(2, "v"), in.number(3, "t"), in.number(4, "r")};
}

Outcome movej(const RobotPtr & robot, CallContext & context, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector6 six = in.six(0, "q");
  const MoveOptions options = move_options(in);
  if (!in) {
    return in.failure();
  }
  const auto target = joint_target(*robot, arguments[0], six);
  if (!target) {
    return Failure{target.error()};
  }
  return begin_path(robot, context, [q = *target, options](Arm & arm) { return arm.move_joint(q, options); });
}

Outcome movel(const RobotPtr & robot, CallContext & context, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector6 six = in.six(0, "pose");
  const MoveOptions options = move_options(in);
  if (!in) {
    return in.failure();
  }
  const Vector6 target = tcp_target(*robot, arguments[0], six);
  return begin_path(robot, context,
                    [target, options](Arm & arm) { return arm.move_linear(target, options); });
}

}  // namespace

void add_move_builtins(Library & library, const RobotPtr & robot)
{
  library.add(
      {"movej",
       {"q", {"a", Value(1.4)}, {"v", Value(1.05)}, {"t", Value(0)}, {"r", Value(0)}},
       1,
       [robot](CallContext & context, Arguments arguments) { return movej(robot, context, arguments); }});
  library.add(
      {"movel",
       {"pose", {"a", Value(1.2)}, {"v", Value(0.25)}, {"t", Value(0)}, {"r", Value(0)}},
       1,
       [robot](CallContext & context, Arguments arguments) { return movel(robot, context, arguments); }});
  add_path_builtins(library, robot);
  library.add({"get_target_waypoint", {}, 0, [robot](CallContext &, Arguments) -> Outcome {
                 return Value::pose(robot->moving != nullptr ? robot->waypoint
                                                             : robot->state().target_tcp_pose);
               }});
}

}  // namespace ur_simulator::script_api
