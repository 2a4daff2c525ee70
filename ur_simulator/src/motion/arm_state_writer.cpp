#include "motion/arm_state_writer.hpp"

#include "common/pose.hpp"
#include "kinematics/forward_kinematics.hpp"
#include "state/electrical_constants.hpp"

namespace ur_simulator {

ArmStateWriter::ArmStateWriter(const RobotModel & model, double cycle_time)
    : model_(model), cycle_time_(cycle_time), dynamics_(model)
{
}

void ArmStateWriter::write(const Setpoint & target, const JointServoLoop & actual, ControllerState & state)
{
  dynamics_.set_payload(state.payload);
  dynamics_.set_gravity(state.gravity);
  write_joints(target.position, target.velocity, state.target);
  write_joints(actual.position(), actual.velocity(), state.actual);
  write_target(state);
  write_actual(state);
  state.measured = {state.actual.position, state.actual.current, state.actual_tcp_pose,
                    state.tool_acceleration};
  first_cycle_ = false;
}

void ArmStateWriter::reset()
{
  first_cycle_ = true;
}

void ArmStateWriter::write_joints(const Vector6 & position, const Vector6 & velocity,
                                  JointState & joints) const
{
  joints.acceleration = derivative(velocity, joints.velocity);
  joints.position = position;
  joints.velocity = velocity;
}

void ArmStateWriter::write_target(ControllerState & state) const
{
  const auto frames = link_frames(model_, state.target.position);
  const Transform tcp = frames[5] * to_transform(state.tcp_offset);
  state.target_tcp_pose = to_pose(tcp);
  const Vector6 previous_speed = state.target_tcp_speed;
  state.target_tcp_speed = jacobian(frames, tcp.translation()) * state.target.velocity;
  state.target_tcp_acceleration = derivative(state.target_tcp_speed, previous_speed);
  state.target.torque = dynamics_.inverse_dynamics(frames, state.target.velocity, state.target.acceleration,
                                                   &state.target_base_wrench);
  state.target.current = dynamics_.currents(state.target.torque);
}

void ArmStateWriter::write_actual(ControllerState & state)
{
  const auto frames = link_frames(model_, state.actual.position);
  const Transform tcp = frames[5] * to_transform(state.tcp_offset);
  const Matrix6 tcp_jacobian = jacobian(frames, tcp.translation());
  state.actual_tcp_pose = to_pose(tcp);
  const Vector6 previous_speed = state.actual_tcp_speed;
  state.actual_tcp_speed = tcp_jacobian * state.actual.velocity;
  state.actual_tcp_acceleration = derivative(state.actual_tcp_speed, previous_speed);
  state.elbow_position = frames[1].translation();
  state.elbow_velocity =
      jacobian(frames, state.elbow_position).topLeftCorner<3, 2>() * state.actual.velocity.head<2>();

  const Eigen::Matrix<double, 3, 6> forces = tcp_jacobian.topRows<3>();
  state.tcp_compliance = forces * model_.stiffness.cwiseInverse().asDiagonal() * forces.transpose();

  const Vector3 angular = state.actual_tcp_speed.tail<3>();
  const Vector3 arm = frames[5].translation() - tcp.translation();
  const Vector3 flange_velocity = state.actual_tcp_speed.head<3>() + angular.cross(arm);
  const Vector3 acceleration = derivative(flange_velocity, flange_velocity_);
  flange_velocity_ = flange_velocity;
  state.tool_acceleration = frames[5].linear().transpose() * (acceleration + state.gravity);

  if (state.robot_mode == RobotMode::running) {
    // The joints carry the arm and counteract the contact wrench at the tool.
    state.actual.torque =
        dynamics_.inverse_dynamics(frames, state.actual.velocity, state.actual.acceleration) -
        tcp_jacobian.transpose() * state.contact_wrench;
  } else {
    state.actual.torque.setZero();  // the brakes hold
  }
  state.actual.current = dynamics_.currents(state.actual.torque);
  add_energy(state);
}

void ArmStateWriter::add_energy(ControllerState & state) const
{
  const double idle_power = state.is_powered() ? main_voltage * idle_robot_current : 0.0;
  const Vector6 mechanical_power = state.actual.torque.cwiseProduct(state.actual.velocity);
  state.energy.consumed += (idle_power + mechanical_power.cwiseMax(0.0).sum()) * cycle_time_;
  state.energy.braking_dissipated -= mechanical_power.cwiseMin(0.0).sum() * cycle_time_;
}

}  // namespace ur_simulator
