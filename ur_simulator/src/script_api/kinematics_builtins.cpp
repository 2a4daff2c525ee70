#include "kinematics/forward.hpp"
#include "kinematics/inverse.hpp"
#include "script_api/robot.hpp"

namespace ur_simulator::script_api {

namespace {

constexpr std::uint32_t inverse_cost = 200;

/// The arguments of the inverse kinematics: (x, qnear, maxPositionError, maxOrientationError, tcp). Older
/// programs give the TCP in third place, newer ones by name.
struct InverseRequest {
  Vector6 pose;
  Vector6 near;
  Vector6 tcp;
  double position_error;
};

InverseRequest inverse_request(const Robot & robot, Arguments arguments, ArgumentReader & in)
{
  InverseRequest request{in.pose(0, "x"), robot.state().target.position, robot.state().tcp_offset, 1e-10};
  if (in.given(1)) {
    request.near = in.six(1, "qnear");
  }
  const bool tcp_third = in.given(2) && arguments[2].is(urscript::Type::pose);
  if (tcp_third) {
    request.tcp = in.pose(2, "tcp");
  } else if (in.given(2)) {
    request.position_error = in.number(2, "maxPositionError");
  }
  if (in.given(3)) {
    in.number(3, "maxOrientationError");
  }
  if (in.given(4)) {
    request.tcp = in.pose(4, "tcp");
  }
  return request;
}

tl::expected<Vector6, std::string> solve(const Robot & robot, const InverseRequest & request)
{
  return get_inverse_kin(robot.access.model, request.pose, request.near, request.tcp, request.position_error);
}

Outcome inverse(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const InverseRequest request = inverse_request(robot, arguments, in);
  if (!in) {
    return in.failure();
  }
  const auto solution = solve(robot, request);
  return solution ? Outcome(Value::list(*solution)) : Failure{solution.error()};
}

Outcome has_inverse(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const InverseRequest request = inverse_request(robot, arguments, in);
  return in ? Outcome(Value(solve(robot, request).has_value())) : in.failure();
}

Outcome forward(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector6 q = in.given(0) ? in.six(0, "q") : robot.state().actual.position;
  const Vector6 tcp = in.given(1) ? in.pose(1, "tcp") : robot.state().tcp_offset;
  return in ? Outcome(Value::pose(forward_tcp(robot.access.model, q, tcp))) : in.failure();
}

bool joints_within_limits(const RobotModel & model, const Vector6 & q)
{
  return (q.array() >= model.position_min.array()).all() && (q.array() <= model.position_max.array()).all();
}

// Joint limits and reach; safety planes belong to installations, which the simulator has none of.
Outcome within_safety_limits(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector6 six = in.six(0, "pose");
  if (!in) {
    return in.failure();
  }
  const RobotModel & model = robot.access.model;
  if (!arguments[0].is(urscript::Type::pose)) {
    return Value(joints_within_limits(model, six));
  }
  return Value(
      get_inverse_kin(model, six, robot.state().target.position, robot.state().tcp_offset).has_value());
}

}  // namespace

void add_kinematics_builtins(Library & library, const RobotPtr & robot)
{
  const std::vector<urscript::Parameter> parameters{"x", "qnear", "maxPositionError", "maxOrientationError",
                                                    "tcp"};
  add_bound(library, robot, "get_inverse_kin", parameters, 1, inverse, inverse_cost);
  add_bound(library, robot, "get_inverse_kin_has_solution", parameters, 1, has_inverse, inverse_cost);
  add_bound(library, robot, "get_forward_kin", {"q", "tcp"}, 0, forward, 40);
  add_bound(library, robot, "is_within_safety_limits", {"pose"}, 1, within_safety_limits, inverse_cost);
}

}  // namespace ur_simulator::script_api
