#include "kinematics/forward_kinematics.hpp"
#include "kinematics/inverse_kinematics.hpp"
#include "script_api/robot_context.hpp"

namespace ur_simulator::script_api {

namespace {

constexpr std::uint32_t inverse_cost = 200;

/// Arguments of the inverse kinematics: (x, qnear, maxPositionError, maxOrientationError, tcp). Programs also
/// pass the TCP as the third argument.
struct InverseRequest {
  Vector6 pose;
  Vector6 near;
  Vector6 tcp;
  double position_error;
};

InverseRequest inverse_request(const RobotContext & robot, Arguments arguments, ArgumentReader & reader)
{
  InverseRequest request{reader.pose(0, "x"), robot.state().target.position, robot.state().tcp_offset, 1e-10};
  if (reader.given(1)) {
    request.near = reader.vector6(1, "qnear");
  }
  const bool tcp_third = reader.given(2) && arguments[2].is(urscript::Type::pose);
  if (tcp_third) {
    request.tcp = reader.pose(2, "tcp");
  } else if (reader.given(2)) {
    request.position_error = reader.number(2, "maxPositionError");
  }
  if (reader.given(3)) {
    reader.number(3, "maxOrientationError");
  }
  if (reader.given(4)) {
    request.tcp = reader.pose(4, "tcp");
  }
  return request;
}

tl::expected<Vector6, std::string> solve(const RobotContext & robot, const InverseRequest & request)
{
  return get_inverse_kin(robot.access.model, request.pose, request.near, request.tcp, request.position_error);
}

Outcome inverse(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const InverseRequest request = inverse_request(robot, arguments, reader);
  if (!reader) {
    return reader.failure();
  }
  const auto solution = solve(robot, request);
  return solution ? Outcome(Value::list(*solution)) : Failure{solution.error()};
}

Outcome has_inverse(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const InverseRequest request = inverse_request(robot, arguments, reader);
  return reader ? Outcome(Value(solve(robot, request).has_value())) : reader.failure();
}

Outcome forward(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector6 q = reader.given(0) ? reader.vector6(0, "q") : robot.state().measured.position;
  const Vector6 tcp = reader.given(1) ? reader.pose(1, "tcp") : robot.state().tcp_offset;
  return reader ? Outcome(Value::pose(tcp_pose(robot.access.model, q, tcp))) : reader.failure();
}

bool joints_within_limits(const RobotModel & model, const Vector6 & q)
{
  return (q.array() >= model.position_min.array()).all() && (q.array() <= model.position_max.array()).all();
}

// Checks joint limits and reach. The simulator has no safety planes.
Outcome within_safety_limits(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector6 target_values = reader.vector6(0, "position");
  const Vector6 near = reader.given(1) ? reader.vector6(1, "qNear") : robot.state().target.position;
  if (!reader) {
    return reader.failure();
  }
  const RobotModel & model = robot.access.model;
  if (!arguments[0].is(urscript::Type::pose)) {
    return Value(joints_within_limits(model, target_values));
  }
  return Value(get_inverse_kin(model, target_values, near, robot.state().tcp_offset).has_value());
}

}  // namespace

void add_kinematics_builtins(Library & library, const RobotContextPtr & robot)
{
  const std::vector<urscript::Parameter> parameters{"x", "qnear", "maxPositionError", "maxOrientationError",
                                                    "tcp"};
  add_robot_builtin(library, robot, "get_inverse_kin", parameters, 1, inverse, inverse_cost);
  std::vector<urscript::Parameter> query_parameters = parameters;
  query_parameters.front() = urscript::Parameter("pose").formerly("x");
  add_robot_builtin(library, robot, "get_inverse_kin_has_solution", query_parameters, 1, has_inverse,
                    inverse_cost);
  add_robot_builtin(library, robot, "get_forward_kin", {"q", "tcp"}, 0, forward, 40);
  add_robot_builtin(library, robot, "is_within_safety_limits",
                    {urscript::Parameter("position").formerly("pose"), "qNear"}, 1, within_safety_limits,
                    inverse_cost);
  library.simplify("is_within_safety_limits", "checks joint limits and reach; there are no safety planes");
}

}  // namespace ur_simulator::script_api
