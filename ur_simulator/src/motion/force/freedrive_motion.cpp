#include "motion/force/freedrive_motion.hpp"

#include <algorithm>
#include <cmath>

#include "common/pose.hpp"
#include "kinematics/forward_kinematics.hpp"
#include "kinematics/inverse_kinematics.hpp"

namespace ur_simulator {
namespace {

// Friction that the hand feels, as multiples of the friction of the gears: most Coulomb friction is
// compensated, additional viscous friction damps the arm.
constexpr double viscous_scale = 1.7;
constexpr double coulomb_scale = 0.2;
constexpr double stop_deceleration = 10.0;   // rad/s^2
constexpr double limit_deceleration = 8.0;   // rad/s^2 at which a joint can still stop before its limit
constexpr double position_gain = 20.0;       // 1/s, of the control of a constrained axis
constexpr double stiffening_distance = 0.1;  // singularity_distance() below which friction grows
constexpr double max_stiffening = 20.0;

}  // namespace

FreedriveMotion::FreedriveMotion(const RobotModel & model, ForwardDynamics & dynamics,
                                 const ControllerState & state, const std::array<bool, 6> & free_axes,
                                 const Vector6 & feature)
    : model_(&model),
      dynamics_(&dynamics),
      state_(&state),
      free_axes_(free_axes),
      axes_(to_rotation_matrix(feature.tail<3>())),
      start_(to_transform(state.actual_tcp_pose))
{
}

bool FreedriveMotion::constrained() const
{
  return std::ranges::find(free_axes_, false) != free_axes_.end();
}

std::optional<MotionFault> FreedriveMotion::advance(const TimeStep & time_step, Setpoint & setpoint)
{
  const double step = stop_deceleration * time_step.duration;
  Vector6 velocity = decelerating_
                         ? Vector6(setpoint.velocity - setpoint.velocity.cwiseMax(-step).cwiseMin(step))
                         : guided_velocity(time_step, setpoint);
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double up = std::max(0.0, model_->position_max[i] - setpoint.position[i]);
    const double down = std::max(0.0, setpoint.position[i] - model_->position_min[i]);
    const double max_speed = model_->velocity_max[i];
    velocity[i] = std::clamp(velocity[i], -std::min(max_speed, std::sqrt(2.0 * limit_deceleration * down)),
                             std::min(max_speed, std::sqrt(2.0 * limit_deceleration * up)));
  }
  const Vector6 next = (setpoint.position + velocity * time_step.duration)
                           .cwiseMax(model_->position_min)
                           .cwiseMin(model_->position_max);
  setpoint = {next, (next - setpoint.position) / time_step.duration};
  finished_ = decelerating_ && velocity.isZero(0.0);
  return std::nullopt;
}

Vector6 FreedriveMotion::guided_velocity(const TimeStep & time_step, const Setpoint & setpoint) const
{
  double viscous = viscous_scale;
  if (constrained()) {
    const double closeness =
        std::max(0.0, 1.0 - singularity_distance(*model_, setpoint.position) / stiffening_distance);
    viscous *= 1.0 + max_stiffening * closeness;
  }
  const JointFriction friction =
      JointFriction::of_gears(*model_).scaled(Vector6::Constant(viscous), Vector6::Constant(coulomb_scale));
  const Vector6 velocity =
      dynamics_->next_velocity(setpoint, Vector6::Zero(), friction, time_step.duration, *state_);
  return constrained() ? constrained_velocity(velocity, setpoint) : velocity;
}

Vector6 FreedriveMotion::constrained_velocity(const Vector6 & velocity, const Setpoint & setpoint) const
{
  const auto frames = link_frames(*model_, setpoint.position);
  const Transform tcp = frames[5] * to_transform(state_->tcp_offset);
  const Matrix6 tcp_jacobian = jacobian(frames, tcp.translation());
  Vector6 deviation;
  deviation << tcp.translation() - start_.translation(),
      to_rotation_vector(tcp.linear() * start_.linear().transpose());
  const Vector6 return_twist = -position_gain * rotate_spatial_vector(axes_.transpose(), deviation);
  Matrix6 feature_jacobian;
  feature_jacobian << axes_.transpose() * tcp_jacobian.topRows<3>(),
      axes_.transpose() * tcp_jacobian.bottomRows<3>();

  const auto count = std::ranges::count(free_axes_, false);
  ConstraintJacobian constraint_jacobian(count, 6);
  ConstraintVelocity target_velocity(count);
  for (Eigen::Index axis = 0, row = 0; axis < 6; ++axis) {
    if (!free_axes_[static_cast<std::size_t>(axis)]) {
      constraint_jacobian.row(row) = feature_jacobian.row(axis);
      target_velocity[row++] = return_twist[axis];
    }
  }
  return dynamics_->constrained_velocity(velocity, constraint_jacobian, target_velocity);
}

}  // namespace ur_simulator
