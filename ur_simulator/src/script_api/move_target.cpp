#include "script_api/move_target.hpp"

#include "common/pose.hpp"
#include "kinematics/forward.hpp"
#include "kinematics/inverse.hpp"

namespace ur_simulator::script_api {

namespace {

// Closer than the controller's own resolution of a target.
constexpr double joint_tolerance = 1e-4;  // rad
constexpr double point_tolerance = 1e-4;  // m
constexpr double turn_tolerance = 1e-3;   // rad

}  // namespace

Vector6 tcp_target(const Robot & robot, const Value & target, const Vector6 & six)
{
  return target.is(urscript::Type::pose) ? six
                                         : forward_tcp(robot.access.model, six, robot.state().tcp_offset);
}

tl::expected<Vector6, std::string> joint_target(const Robot & robot, const Value & target,
                                                const Vector6 & six)
{
  if (!target.is(urscript::Type::pose)) {
    return six;
  }
  return get_inverse_kin(robot.access.model, six, robot.state().target.position, robot.state().tcp_offset);
}

MoveOperation::Arrived at_joints(const Vector6 & target)
{
  return [target](const ControllerState & state) {
    return (state.target.position - target).cwiseAbs().maxCoeff() < joint_tolerance;
  };
}

MoveOperation::Arrived at_pose(const Robot & robot, const Vector6 & tcp_pose)
{
  const Transform target = to_transform(tcp_pose) * to_transform(robot.state().tcp_offset).inverse();
  return [&model = robot.access.model, target](const ControllerState & state) {
    const Transform way = forward_flange(model, state.target.position).inverse() * target;
    return way.translation().norm() < point_tolerance &&
           to_rotation_vector(way.linear()).norm() < turn_tolerance;
  };
}

Outcome begin_path(const RobotPtr & robot, CallContext & context, MoveOperation::Start start,
                   MoveOperation::Arrived arrived)
{
  Outcome outcome = begin_move(robot, std::move(start), std::move(arrived));
  if (std::holds_alternative<Value>(outcome)) {
    context.host.text_message(
        fmt::format("Overlapping Blends: the waypoint on line {} is skipped", context.line));
  } else if (const auto ends = robot->access.arm.path_ends();
             ends && std::holds_alternative<std::unique_ptr<urscript::Operation>>(outcome)) {
    robot->waypoint = ends->target;
  }
  return outcome;
}

}  // namespace ur_simulator::script_api
