#include "script_api/motion_operation.hpp"

namespace ur_simulator::script_api {

namespace {

Outcome servoj(const RobotPtr & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector6 q = in.six(0, "q");
  // a and v are part of the signature, but not used in the current version of the language.
  const double time = in.number(3, "t");
  const double lookahead = in.number(4, "lookahead_time");
  const double gain = in.number(5, "gain");
  if (!in) {
    return in.failure();
  }
  robot->waypoint = robot->state().target_tcp_pose;
  return begin_motion(robot, [&](Arm & arm) { return arm.servo_joint(q, time, lookahead, gain); });
}

Outcome speedj(const RobotPtr & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector6 qd = in.six(0, "qd");
  const double acceleration = in.number(1, "a");
  const double time = in.given(2) ? in.number(2, "t") : 0.0;
  if (!in) {
    return in.failure();
  }
  robot->waypoint = robot->state().target_tcp_pose;
  return begin_motion(robot, [&](Arm & arm) { return arm.speed_joint(qd, acceleration, time); });
}

Outcome speedl(const RobotPtr & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector6 xd = in.six(0, "xd");
  const double acceleration = in.number(1, "a");
  const double time = in.given(2) ? in.number(2, "t") : 0.0;
  if (!in) {
    return in.failure();
  }
  robot->waypoint = robot->state().target_tcp_pose;
  return begin_motion(robot, [&](Arm & arm) { return arm.speed_linear(xd, acceleration, time); });
}

using Stop = MotionStart (Arm::*)(double);

Outcome stop(const RobotPtr & robot, Arguments arguments, Stop how)
{
  ArgumentReader in(arguments);
  const double deceleration = in.number(0, "a");
  if (!in) {
    return in.failure();
  }
  robot->waypoint = robot->state().target_tcp_pose;
  return begin_motion(robot, [&](Arm & arm) { return (arm.*how)(deceleration); });
}

}  // namespace

void add_speed_builtins(Library & library, const RobotPtr & robot)
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
  library.add({"speedj", {"qd", "a", "t"}, 2, [robot](CallContext &, Arguments arguments) {
                 return speedj(robot, arguments);
               }});
  library.add({"speedl", {"xd", "a", "t", "aRot"}, 2, [robot](CallContext &, Arguments arguments) {
                 return speedl(robot, arguments);
               }});
  library.add({"stopj", {"a"}, 1, [robot](CallContext &, Arguments arguments) {
                 return stop(robot, arguments, &Arm::stop_joint);
               }});
  library.add({"stopl", {"a", "aRot"}, 1, [robot](CallContext &, Arguments arguments) {
                 return stop(robot, arguments, &Arm::stop_linear);
               }});
}

}  // namespace ur_simulator::script_api
