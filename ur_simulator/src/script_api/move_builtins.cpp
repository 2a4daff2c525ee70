#include "common/pose.hpp"
#include "kinematics/forward.hpp"
#include "kinematics/inverse.hpp"
#include "script_api/motion_operation.hpp"

namespace ur_simulator::script_api {

namespace {

// Closer than the controller's own resolution of a target.
constexpr double joint_tolerance = 1e-4;  // rad
constexpr double point_tolerance = 1e-4;  // m
constexpr double turn_tolerance = 1e-3;   // rad

MoveOptions move_options(ArgumentReader & in)
{
  return {in.number(1, "a"), in.number(2, "v"), in.number(3, "t"), in.number(4, "r")};
}

bool at_joints(const ControllerState & state, const Vector6 & target)
{
  return (state.target.position - target).cwiseAbs().maxCoeff() < joint_tolerance;
}

// Compared at the flange: the program may set another TCP while the arm moves.
bool at_flange(const RobotModel & model, const ControllerState & state, const Transform & target)
{
  const Transform way = forward_flange(model, state.target.position).inverse() * target;
  return way.translation().norm() < point_tolerance &&
         to_rotation_vector(way.linear()).norm() < turn_tolerance;
}

tl::expected<Vector6, std::string> joints_of(const Robot & robot, const Value & target, const Vector6 & six)
{
  if (!target.is(urscript::Type::pose)) {
    return six;
  }
  return get_inverse_kin(robot.access.model, six, robot.state().target.position, robot.state().tcp_offset);
}

Outcome movej(const RobotPtr & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector6 six = in.six(0, "q");
  const MoveOptions options = move_options(in);
  if (!in) {
    return in.failure();
  }
  const auto target = joints_of(*robot, arguments[0], six);
  if (!target) {
    return Failure{target.error()};
  }
  robot->waypoint = forward_tcp(robot->access.model, *target, robot->state().tcp_offset);
  return begin_move(
      robot, [q = *target, options](Arm & arm) { return arm.move_joint(q, options); },
      [q = *target](const ControllerState & state) { return at_joints(state, q); });
}

Outcome movel(const RobotPtr & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector6 six = in.six(0, "pose");
  const MoveOptions options = move_options(in);
  if (!in) {
    return in.failure();
  }
  const bool by_joints = !arguments[0].is(urscript::Type::pose);
  const Vector6 target = by_joints ? forward_tcp(robot->access.model, six, robot->state().tcp_offset) : six;
  robot->waypoint = target;
  const Transform flange = to_transform(target) * to_transform(robot->state().tcp_offset).inverse();
  return begin_move(
      robot, [target, options](Arm & arm) { return arm.move_linear(target, options); },
      [&model = robot->access.model, flange](const ControllerState & state) {
        return at_flange(model, state, flange);
      });
}

}  // namespace

void add_move_builtins(Library & library, const RobotPtr & robot)
{
  library.add({"movej",
               {"q", {"a", Value(1.4)}, {"v", Value(1.05)}, {"t", Value(0)}, {"r", Value(0)}},
               1,
               [robot](CallContext &, Arguments arguments) { return movej(robot, arguments); }});
  library.add({"movel",
               {"pose", {"a", Value(1.2)}, {"v", Value(0.25)}, {"t", Value(0)}, {"r", Value(0)}},
               1,
               [robot](CallContext &, Arguments arguments) { return movel(robot, arguments); }});
  library.add({"get_target_waypoint", {}, 0, [robot](CallContext &, Arguments) -> Outcome {
                 return Value::pose(robot->moving != nullptr ? robot->waypoint
                                                             : robot->state().target_tcp_pose);
               }});
}

}  // namespace ur_simulator::script_api
