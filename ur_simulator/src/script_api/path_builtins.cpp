#include <memory>

#include "common/pose.hpp"
#include "script_api/move_target.hpp"

namespace ur_simulator::script_api {

namespace {

/// The options of movep, movec, servoc and optimove*, which have no time.
MoveOptions path_options(ArgumentReader & in, std::size_t first)
{
  return {in.number(first, "a"), in.number(first + 1, "v"), 0.0, in.number(first + 2, "r")};
}

using LinearStart = MotionStart (Arm::*)(const Vector6 & tcp_pose, const MoveOptions & options);

/// movep, optimovel.
Outcome to_pose_by(const RobotPtr & robot, CallContext & context, Arguments arguments, LinearStart how)
{
  ArgumentReader in(arguments);
  const Vector6 six = in.six(0, "pose");
  const MoveOptions options = path_options(in, 1);
  if (!in) {
    return in.failure();
  }
  const Vector6 target = tcp_target(*robot, arguments[0], six);
  return begin_path(robot, context, [=](Arm & arm) { return (arm.*how)(target, options); });
}

Outcome optimovej(const RobotPtr & robot, CallContext & context, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector6 six = in.six(0, "goal");
  const MoveOptions options = path_options(in, 1);
  if (!in) {
    return in.failure();
  }
  const auto target = joint_target(*robot, arguments[0], six);
  if (!target) {
    return Failure{target.error()};
  }
  return begin_path(robot, context,
                    [q = *target, options](Arm & arm) { return arm.move_joint_optimally(q, options); });
}

/// A movec: after a stop it goes on along what is left of the circle it began.
class CircularMove {
 public:
  CircularMove(const Vector6 & via, const Vector6 & target, CircleMode mode, const MoveOptions & options)
      : via_(via), target_(target), mode_(mode), options_(options)
  {
  }

  MotionStart start(Arm & arm, const Robot & robot)
  {
    if (begun_) {
      return go_on(arm, robot);
    }
    MotionStart motion = arm.move_circular(via_, target_, mode_, options_);
    if (const auto ends = arm.path_ends(); motion && *motion != skipped_motion && ends) {
      begun_ = ends->start;
      target_ = ends->target;  // in fixed mode its rotation follows from the circle
    }
    return motion;
  }

 private:
  MotionStart go_on(Arm & arm, const Robot & robot)
  {
    const auto circle = TcpLeg::circle(to_transform(*begun_), via_.head<3>(), to_transform(target_),
                                       CircleMode::unconstrained);
    const Vector3 here = robot.state().target_tcp_pose.head<3>();
    const auto halfway = circle ? circle->halfway_on(here) : std::nullopt;
    if (!halfway) {
      return arm.move_linear(target_, options_);
    }
    Vector6 via = target_;
    via.head<3>() = *halfway;
    return arm.move_circular(via, target_, CircleMode::unconstrained, options_);
  }

  Vector6 via_;
  Vector6 target_;
  CircleMode mode_;
  MoveOptions options_;
  std::optional<Vector6> begun_;  ///< where, once it has
};

Outcome movec(const RobotPtr & robot, CallContext & context, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector6 via = in.six(0, "pose_via");
  const Vector6 to = in.six(1, "pose_to");
  const MoveOptions options = path_options(in, 2);
  const int mode = in.integer(5, "mode");
  in.require(mode == 0 || mode == 1,
             fmt::format("mode = {} is neither 0 (unconstrained) nor 1 (fixed)", mode));
  if (!in) {
    return in.failure();
  }
  const auto move = std::make_shared<CircularMove>(
      tcp_target(*robot, arguments[0], via), tcp_target(*robot, arguments[1], to),
      mode == 1 ? CircleMode::fixed : CircleMode::unconstrained, options);
  // The robot outlives the operation, which holds it.
  return begin_path(robot, context, [move, &shared = *robot](Arm & arm) { return move->start(arm, shared); });
}

Outcome servoc(const RobotPtr & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector6 six = in.six(0, "pose");
  const MoveOptions options = path_options(in, 1);
  if (!in) {
    return in.failure();
  }
  const Vector6 target = tcp_target(*robot, arguments[0], six);
  robot->waypoint = target;
  return begin_motion(robot, [&](Arm & arm) { return arm.servo_circular(target, options); });
}

std::vector<urscript::Parameter> parameters(const char * target, double acceleration, double velocity)
{
  return {target, {"a", Value(acceleration)}, {"v", Value(velocity)}, {"r", Value(0)}};
}

}  // namespace

void add_path_builtins(Library & library, const RobotPtr & robot)
{
  library.add(
      {"movep", parameters("pose", 1.2, 0.25), 1, [robot](CallContext & context, Arguments arguments) {
         return to_pose_by(robot, context, arguments, &Arm::move_process);
       }});
  library.add(
      {"movec",
       {"pose_via", "pose_to", {"a", Value(1.2)}, {"v", Value(0.25)}, {"r", Value(0)}, {"mode", Value(0)}},
       2,
       [robot](CallContext & context, Arguments arguments) { return movec(robot, context, arguments); }});
  library.add({"servoc", parameters("pose", 1.2, 0.25), 1,
               [robot](CallContext &, Arguments arguments) { return servoc(robot, arguments); }});
  library.add(
      {"optimovej", parameters("goal", 0.3, 0.3), 1,
       [robot](CallContext & context, Arguments arguments) { return optimovej(robot, context, arguments); }});
  library.add(
      {"optimovel", parameters("goal", 0.3, 0.3), 1, [robot](CallContext & context, Arguments arguments) {
         return to_pose_by(robot, context, arguments, &Arm::move_linear_optimally);
       }});
}

}  // namespace ur_simulator::script_api
