#include <memory>

#include "common/pose.hpp"
#include "script_api/move_target.hpp"

namespace ur_simulator::script_api {

namespace {

/// Options of movep, movec, servoc and optimove*, which have no time argument.
MoveOptions path_options(ArgumentReader & reader, std::size_t first)
{
  return {reader.number(first, "a"), reader.number(first + 1, "v"), 0.0, reader.number(first + 2, "r")};
}

/// Options after the target in the first argument.
MoveOptions options_after_target(ArgumentReader & reader)
{
  return path_options(reader, 1);
}

/// A movec. After a stop it resumes along the remaining arc of its circle.
class CircularMove {
 public:
  CircularMove(const Vector6 & via, const Vector6 & target, CircleMode mode, const MoveOptions & options)
      : via_(via), target_(target), mode_(mode), options_(options)
  {
  }

  StartResult start(Arm & arm, const RobotContext & robot)
  {
    if (start_pose_) {
      return resume(arm, robot);
    }
    StartResult motion = arm.move_circular(via_, target_, mode_, options_);
    if (const auto ends = arm.path_endpoints(); motion && *motion != skipped_motion_id && ends) {
      start_pose_ = ends->start;
      target_ = ends->target;  // in fixed mode the rotation follows from the circle
    }
    return motion;
  }

 private:
  StartResult resume(Arm & arm, const RobotContext & robot)
  {
    const auto circle = TcpSegment::circle(to_transform(*start_pose_), via_.head<3>(), to_transform(target_),
                                           CircleMode::unconstrained);
    const Vector3 here = robot.state().target_tcp_pose.head<3>();
    const auto halfway = circle ? circle->middle_of_remaining_arc(here) : std::nullopt;
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
  std::optional<Vector6> start_pose_;  ///< where the arc began; nothing before the first start
};

Outcome movec(const RobotContextPtr & robot, CallContext & context, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector6 via = reader.vector6(0, "pose_via");
  const Vector6 to = reader.vector6(1, "pose_to");
  const MoveOptions options = path_options(reader, 2);
  const int mode = reader.integer(5, "mode");
  reader.require(mode == 0 || mode == 1,
                 fmt::format("mode must be 0 (unconstrained) or 1 (fixed), is {}", mode));
  if (!reader) {
    return reader.failure();
  }
  const auto move = std::make_shared<CircularMove>(
      tcp_target(*robot, arguments[0], via), tcp_target(*robot, arguments[1], to),
      mode == 1 ? CircleMode::fixed : CircleMode::unconstrained, options);
  // The operation keeps the robot context alive.
  return start_path_move(robot, context,
                         [move, &shared = *robot](Arm & arm) { return move->start(arm, shared); });
}

Outcome servoc(const RobotContextPtr & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector6 target_values = reader.vector6(0, "pose");
  const MoveOptions options = options_after_target(reader);
  if (!reader) {
    return reader.failure();
  }
  const Vector6 target = tcp_target(*robot, arguments[0], target_values);
  robot->waypoint = target;
  return start_motion(robot, [&](Arm & arm) { return arm.servo_circular(target, options); });
}

std::vector<urscript::Parameter> parameters(const char * target, double acceleration, double velocity)
{
  return {target, {"a", Value(acceleration)}, {"v", Value(velocity)}, {"r", Value(0)}};
}

}  // namespace

void add_path_builtins(Library & library, const RobotContextPtr & robot)
{
  library.add(
      {"movep", parameters("pose", 1.2, 0.25), 1, [robot](CallContext & context, Arguments arguments) {
         return move_to_pose(robot, context, arguments, "pose", options_after_target, &Arm::move_process);
       }});
  library.add(
      {"movec",
       {"pose_via", "pose_to", {"a", Value(1.2)}, {"v", Value(0.25)}, {"r", Value(0)}, {"mode", Value(0)}},
       2,
       [robot](CallContext & context, Arguments arguments) { return movec(robot, context, arguments); }});
  library.add({"servoc", parameters("pose", 1.2, 0.25), 1,
               [robot](CallContext &, Arguments arguments) { return servoc(robot, arguments); }});
  library.add(
      {"optimovej", parameters("goal", 0.3, 0.3), 1, [robot](CallContext & context, Arguments arguments) {
         return move_to_joints(robot, context, arguments, "goal", options_after_target,
                               &Arm::move_joint_optimally);
       }});
  library.add(
      {"optimovel", parameters("goal", 0.3, 0.3), 1, [robot](CallContext & context, Arguments arguments) {
         return move_to_pose(robot, context, arguments, "goal", options_after_target,
                             &Arm::move_linear_optimally);
       }});
  for (const char * name : {"optimovej", "optimovel"}) {
    library.simplify(name, "targets in the base frame only");
  }
}

}  // namespace ur_simulator::script_api
