#include "script_api/move_target.hpp"

namespace ur_simulator::script_api {

namespace {

MoveOptions move_options(ArgumentReader & reader)
{
  return {reader.number(1, "a"), reader.number(2, "v"), reader.number(3, "t"), reader.number(4, "r")};
}

}  // namespace

void add_move_builtins(Library & library, const RobotContextPtr & robot)
{
  library.add({"movej",
               {"q", {"a", Value(1.4)}, {"v", Value(1.05)}, {"t", Value(0)}, {"r", Value(0)}},
               1,
               [robot](CallContext & context, Arguments arguments) {
                 return move_to_joints(robot, context, arguments, "q", move_options, &Arm::move_joint);
               }});
  library.add({"movel",
               {"pose", {"a", Value(1.2)}, {"v", Value(0.25)}, {"t", Value(0)}, {"r", Value(0)}},
               1,
               [robot](CallContext & context, Arguments arguments) {
                 return move_to_pose(robot, context, arguments, "pose", move_options, &Arm::move_linear);
               }});
  add_path_builtins(library, robot);
  library.add({"get_target_waypoint", {}, 0, [robot](CallContext &, Arguments) -> Outcome {
                 return Value::pose(robot->motion_owner != nullptr ? robot->waypoint
                                                                   : robot->state().target_tcp_pose);
               }});
}

}  // namespace ur_simulator::script_api
