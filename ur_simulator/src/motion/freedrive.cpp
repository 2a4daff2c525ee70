#include "motion/freedrive.hpp"

#include <algorithm>
#include <cmath>

#include "common/pose.hpp"
#include "kinematics/forward.hpp"
#include "kinematics/inverse.hpp"

namespace ur_simulator {
namespace {

// What a hand feels: most of the gears' friction is compensated, some viscous resistance keeps the arm calm.
constexpr double viscous_feel = 1.7;  // times the gears' own
constexpr double coulomb_feel = 0.2;
constexpr double braking_deceleration = 10.0;  // rad/s^2
constexpr double limit_deceleration = 8.0;     // rad/s^2 at which a joint can still stop before its limit
constexpr double return_rate = 20.0;           // 1/s at which a held axis goes back to its place
constexpr double stiff_below = 0.1;            // dexterity
constexpr double stiffest = 20.0;

}  // namespace

Freedrive::Freedrive(const RobotModel & model, ForwardDynamics & dynamics, const ControllerState & state,
                     const std::array<bool, 6> & free_axes, const Vector6 & feature)
    : model_(&model),
      dynamics_(&dynamics),
      state_(&state),
      free_axes_(free_axes),
      axes_(to_rotation(feature.tail<3>())),
      start_(to_transform(state.actual_tcp_pose))
{
}

bool Freedrive::constrained() const
{
  return std::ranges::find(free_axes_, false) != free_axes_.end();
}

std::optional<MotionFault> Freedrive::advance(const Tick & tick, Setpoint & now)
{
  const double step = braking_deceleration * tick.duration;
  Vector6 velocity =
      braking_ ? Vector6(now.velocity - now.velocity.cwiseMax(-step).cwiseMin(step)) : guided(tick, now);
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double up = std::max(0.0, model_->position_max[i] - now.position[i]);
    const double down = std::max(0.0, now.position[i] - model_->position_min[i]);
    const double fastest = model_->velocity_max[i];
    velocity[i] = std::clamp(velocity[i], -std::min(fastest, std::sqrt(2.0 * limit_deceleration * down)),
                             std::min(fastest, std::sqrt(2.0 * limit_deceleration * up)));
  }
  const Vector6 next =
      (now.position + velocity * tick.duration).cwiseMax(model_->position_min).cwiseMin(model_->position_max);
  now = {next, (next - now.position) / tick.duration};
  done_ = braking_ && velocity.isZero(0.0);
  return std::nullopt;
}

Vector6 Freedrive::guided(const Tick & tick, const Setpoint & now) const
{
  double viscous = viscous_feel;
  if (constrained()) {
    const double near = std::max(0.0, 1.0 - dexterity(*model_, now.position) / stiff_below);
    viscous *= 1.0 + stiffest * near;
  }
  const JointFriction friction =
      JointFriction::of(*model_).scaled(Vector6::Constant(viscous), Vector6::Constant(coulomb_feel));
  const Vector6 velocity = dynamics_->next_velocity(now, Vector6::Zero(), friction, tick.duration, *state_);
  return constrained() ? held(velocity, now) : velocity;
}

Vector6 Freedrive::held(const Vector6 & velocity, const Setpoint & now) const
{
  const auto frames = link_frames(*model_, now.position);
  const Transform tcp = frames[5] * to_transform(state_->tcp_offset);
  const Matrix6 lever = jacobian(frames, tcp.translation());
  Vector6 strayed;
  strayed << tcp.translation() - start_.translation(),
      to_rotation_vector(tcp.linear() * start_.linear().transpose());
  const Vector6 back = -return_rate * rotate_pair(axes_.transpose(), strayed);
  Matrix6 in_axes;
  in_axes << axes_.transpose() * lever.topRows<3>(), axes_.transpose() * lever.bottomRows<3>();

  const auto count = std::ranges::count(free_axes_, false);
  ConstraintRows rows(count, 6);
  ConstraintValues wanted(count);
  for (Eigen::Index axis = 0, row = 0; axis < 6; ++axis) {
    if (!free_axes_[static_cast<std::size_t>(axis)]) {
      rows.row(row) = in_axes.row(axis);
      wanted[row++] = back[axis];
    }
  }
  return dynamics_->constrained_velocity(velocity, rows, wanted);
}

}  // namespace ur_simulator
