#include "script_api/motion_operation.hpp"

namespace ur_simulator::script_api {

namespace {

Outcome servoj(const RobotContextPtr & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector6 q = reader.vector6(0, "q");
  // The arguments a and v are not used in current versions (script manual, "servoj").
  const double time = reader.number(3, "t");
  const double lookahead = reader.number(4, "lookahead_time");
  const double gain = reader.number(5, "gain");
  if (!reader) {
    return reader.failure();
  }
  robot->waypoint = robot->state().target_tcp_pose;
  return start_motion(robot, [&](Arm & arm) { return arm.servo_joint(q, time, lookahead, gain); });
}

/// speedj, speedl. `name` of the velocity.
Outcome move_at_speed(const RobotContextPtr & robot, Arguments arguments, const char * name, bool linear)
{
  ArgumentReader reader(arguments);
  const Vector6 velocity = reader.vector6(0, name);
  const double acceleration = reader.number(1, "a");
  const double time = reader.given(2) ? reader.number(2, "t") : 0.0;
  const double rotational = linear && reader.given(3) ? reader.number(3, "aRot") : acceleration;
  if (!reader) {
    return reader.failure();
  }
  robot->waypoint = robot->state().target_tcp_pose;
  return start_motion(robot, [&](Arm & arm) {
    return linear ? arm.speed_linear(velocity, acceleration, time, rotational)
                  : arm.speed_joint(velocity, acceleration, time);
  });
}

Outcome stop(const RobotContextPtr & robot, Arguments arguments, bool linear)
{
  ArgumentReader reader(arguments);
  const double deceleration = reader.number(0, "a");
  const double rotational = linear && reader.given(1) ? reader.number(1, "aRot") : deceleration;
  if (!reader) {
    return reader.failure();
  }
  robot->waypoint = robot->state().target_tcp_pose;
  return start_motion(robot, [&](Arm & arm) {
    return linear ? arm.stop_linear(deceleration, rotational) : arm.stop_joint(deceleration);
  });
}

}  // namespace

void add_servo_speed_builtins(Library & library, const RobotContextPtr & robot)
{
  library.add({"servoj",
               {"q",
                {"a", Value(0)},
                {"v", Value(0)},
                {"t", Value(0.002)},
                {"lookahead_time", Value(0.1)},
                {"gain", Value(300)}},
               1,
               [robot](CallContext &, Arguments arguments) { return servoj(robot, arguments); }});
  const urscript::Parameter time = urscript::Parameter("t").formerly("t_min");
  library.add({"speedj", {"qd", "a", time}, 2, [robot](CallContext &, Arguments arguments) {
                 return move_at_speed(robot, arguments, "qd", false);
               }});
  library.add({"speedl", {"xd", "a", time, "aRot"}, 2, [robot](CallContext &, Arguments arguments) {
                 return move_at_speed(robot, arguments, "xd", true);
               }});
  library.add({"stopj", {"a"}, 1, [robot](CallContext &, Arguments arguments) {
                 return stop(robot, arguments, false);
               }});
  library.add({"stopl", {"a", "aRot"}, 1, [robot](CallContext &, Arguments arguments) {
                 return stop(robot, arguments, true);
               }});
}

}  // namespace ur_simulator::script_api
