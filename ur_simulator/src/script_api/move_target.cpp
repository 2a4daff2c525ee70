#include "script_api/move_target.hpp"

#include "kinematics/forward_kinematics.hpp"
#include "kinematics/inverse_kinematics.hpp"

namespace ur_simulator::script_api {

Vector6 tcp_target(const RobotContext & robot, const Value & target, const Vector6 & target_values)
{
  return target.is(urscript::Type::pose)
             ? target_values
             : tcp_pose(robot.access.model, target_values, robot.state().tcp_offset);
}

tl::expected<Vector6, std::string> joint_target(const RobotContext & robot, const Value & target,
                                                const Vector6 & target_values)
{
  if (!target.is(urscript::Type::pose)) {
    return target_values;
  }
  return get_inverse_kin(robot.access.model, target_values, robot.state().target.position,
                         robot.state().tcp_offset);
}

namespace {

/// A path to an unreachable pose: a protective stop, again whenever the program is resumed.
class UnreachableMove : public urscript::PendingCall {
 public:
  UnreachableMove(const RobotContextPtr & robot, std::string reason)
      : robot_(robot), reason_(std::move(reason))
  {
    stop();
  }
  tl::expected<std::optional<Value>, std::string> poll(CallContext &) override
  {
    stop();
    return std::nullopt;
  }

 private:
  void stop()
  {
    if (const auto & protective_stop = robot_->access.requests.protective_stop) {
      protective_stop(error_codes::invalid_setpoint, reason_);
    }
  }

  RobotContextPtr robot_;
  std::string reason_;
};

}  // namespace

Outcome start_path_move(const RobotContextPtr & robot, CallContext & context,
                        MoveOperation::StartFunction start)
{
  Outcome outcome = start_move(robot, std::move(start));
  if (std::holds_alternative<Value>(outcome)) {
    context.host.text_message(
        fmt::format("Overlapping Blends: the waypoint on line {} is skipped", context.line));
  } else if (const auto ends = robot->access.arm.path_endpoints();
             ends && std::holds_alternative<std::unique_ptr<urscript::PendingCall>>(outcome)) {
    robot->waypoint = ends->target;
  }
  return outcome;
}

Outcome move_to_joints(const RobotContextPtr & robot, CallContext & context, Arguments arguments,
                       const char * target_name, OptionsReader read_options, MoveFunction move)
{
  ArgumentReader reader(arguments);
  const Vector6 target_values = reader.vector6(0, target_name);
  const MoveOptions options = read_options(reader);
  if (!reader) {
    return reader.failure();
  }
  const auto target = joint_target(*robot, arguments[0], target_values);
  if (!target) {
    return Failure{target.error()};
  }
  return start_path_move(robot, context,
                         [q = *target, options, move](Arm & arm) { return (arm.*move)(q, options); });
}

Outcome move_to_pose(const RobotContextPtr & robot, CallContext & context, Arguments arguments,
                     const char * target_name, OptionsReader read_options, MoveFunction move)
{
  ArgumentReader reader(arguments);
  const Vector6 target_values = reader.vector6(0, target_name);
  const MoveOptions options = read_options(reader);
  if (!reader) {
    return reader.failure();
  }
  const Vector6 target = tcp_target(*robot, arguments[0], target_values);
  if (const auto joints = joint_target(*robot, Value::pose(target), target); !joints) {
    return std::make_unique<UnreachableMove>(robot, joints.error());
  }
  return start_path_move(robot, context, [=](Arm & arm) { return (arm.*move)(target, options); });
}

}  // namespace ur_simulator::script_api
