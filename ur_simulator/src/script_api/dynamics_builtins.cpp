#include "kinematics/forward.hpp"
#include "script_api/robot.hpp"

namespace ur_simulator::script_api {

namespace {

Value to_matrix(const Matrix6 & matrix)
{
  urscript::Matrix result{6, 6, {}};
  for (Eigen::Index row = 0; row < 6; ++row) {
    for (Eigen::Index column = 0; column < 6; ++column) {
      result.elements.push_back(matrix(row, column));
    }
  }
  return result;
}

Vector6 positions(const Robot & robot, ArgumentReader & in)
{
  return in.given(0) ? in.six(0, "q") : robot.state().actual.position;
}

Dynamics & present(Robot & robot)
{
  robot.dynamics.set_payload(robot.state().payload);
  robot.dynamics.set_gravity(robot.state().gravity);
  return robot.dynamics;
}

Outcome mass_matrix(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector6 q = positions(robot, in);
  return in ? Outcome(to_matrix(present(robot).mass_matrix(q))) : in.failure();
}

Outcome coriolis(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector6 q = positions(robot, in);
  const Vector6 qd = in.given(1) ? in.six(1, "qd") : robot.state().actual.velocity;
  return in ? Outcome(Value::list(present(robot).coriolis_torques(q, qd))) : in.failure();
}

Outcome jacobian_builtin(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector6 q = positions(robot, in);
  const Vector6 tcp = in.given(1) ? in.pose(1, "tcp") : robot.state().tcp_offset;
  return in ? Outcome(to_matrix(jacobian(robot.access.model, q, tcp))) : in.failure();
}

Outcome jacobian_derivative(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector6 q = positions(robot, in);
  const Vector6 qd = in.given(1) ? in.six(1, "qd") : robot.state().actual.velocity;
  const Vector6 tcp = in.given(2) ? in.pose(2, "tcp") : robot.state().tcp_offset;
  return in ? Outcome(to_matrix(jacobian_time_derivative(robot.access.model, q, qd, tcp))) : in.failure();
}

}  // namespace

void add_dynamics_builtins(Library & library, const RobotPtr & robot)
{
  add_bound(library, robot, "get_mass_matrix", {"q", "include_rotors_inertia"}, 0, mass_matrix, 300);
  add_bound(library, robot, "get_coriolis_and_centrifugal_torques", {"q", "qd"}, 0, coriolis, 100);
  add_bound(library, robot, "get_jacobian", {"q", "tcp"}, 0, jacobian_builtin, 60);
  add_bound(library, robot, "get_jacobian_time_derivative", {"q", "qd", "tcp"}, 0, jacobian_derivative, 100);
}

}  // namespace ur_simulator::script_api
