#include "script_api/move_target.hpp"

#include "kinematics/forward.hpp"
#include "kinematics/inverse.hpp"

namespace ur_simulator::script_api {

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

Outcome begin_path(const RobotPtr & robot, CallContext & context, MoveOperation::Start start)
{
  Outcome outcome = begin_move(robot, std::move(start));
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
