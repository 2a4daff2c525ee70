#include "kinematics/forward_kinematics.hpp"
#include "script_api/robot_context.hpp"

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

Vector6 positions(const RobotContext & robot, ArgumentReader & reader)
{
  return reader.given(0) ? reader.vector6(0, "q") : robot.state().actual.position;
}

Dynamics & updated_dynamics(RobotContext & robot)
{
  robot.dynamics.set_payload(robot.state().payload);
  robot.dynamics.set_gravity(robot.state().gravity);
  return robot.dynamics;
}

Outcome mass_matrix(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector6 q = positions(robot, reader);
  return reader ? Outcome(to_matrix(updated_dynamics(robot).mass_matrix(q))) : reader.failure();
}

Outcome coriolis(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector6 q = positions(robot, reader);
  const Vector6 qd = reader.given(1) ? reader.vector6(1, "qd") : robot.state().actual.velocity;
  return reader ? Outcome(Value::list(updated_dynamics(robot).coriolis_torques(q, qd))) : reader.failure();
}

Outcome jacobian_builtin(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector6 q = positions(robot, reader);
  const Vector6 tcp = reader.given(1) ? reader.pose(1, "tcp") : robot.state().tcp_offset;
  return reader ? Outcome(to_matrix(jacobian(robot.access.model, q, tcp))) : reader.failure();
}

Outcome jacobian_derivative(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector6 q = positions(robot, reader);
  const Vector6 qd = reader.given(1) ? reader.vector6(1, "qd") : robot.state().actual.velocity;
  const Vector6 tcp = reader.given(2) ? reader.pose(2, "tcp") : robot.state().tcp_offset;
  return reader ? Outcome(to_matrix(jacobian_time_derivative(robot.access.model, q, qd, tcp)))
                : reader.failure();
}

}  // namespace

void add_dynamics_builtins(Library & library, const RobotContextPtr & robot)
{
  add_robot_builtin(library, robot, "get_mass_matrix", {"q", "include_rotors_inertia"}, 0, mass_matrix, 300);
  add_robot_builtin(library, robot, "get_coriolis_and_centrifugal_torques", {"q", "qd"}, 0, coriolis, 100);
  add_robot_builtin(library, robot, "get_jacobian", {"q", "tcp"}, 0, jacobian_builtin, 60);
  add_robot_builtin(library, robot, "get_jacobian_time_derivative", {"q", "qd", "tcp"}, 0,
                    jacobian_derivative, 100);
}

}  // namespace ur_simulator::script_api
