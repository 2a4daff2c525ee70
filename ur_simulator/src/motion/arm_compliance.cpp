#include <cmath>

#include "motion/arm_impl.hpp"

namespace ur_simulator {
namespace {

constexpr double end_deceleration = 4.0;  // rad/s^2 at which the motion of compliant axes runs out

Refusal bad_force_mode(const ForceModeSettings & settings)
{
  constexpr std::string_view call = "force_mode";
  if (auto refusal = first_of({not_finite(call, "task_frame", settings.frame),
                               not_finite(call, "wrench", settings.wrench),
                               not_finite(call, "limits", settings.limits)})) {
    return refusal;
  }
  for (Eigen::Index i = 0; i < 6; ++i) {
    if (auto refusal = not_within(call, fmt::format("limits[{}]", i), settings.limits[i], 0.0, 1e9)) {
      return refusal;
    }
  }
  return std::nullopt;
}

}  // namespace

tl::expected<void, std::string> Arm::start_force_mode(const ForceModeSettings & settings)
{
  if (const auto refusal = first_of({impl_->not_ready("force_mode"), bad_force_mode(settings)})) {
    return tl::unexpected(*refusal);
  }
  if (impl_->force) {
    impl_->force->update(settings);
  } else {
    impl_->force.emplace(impl_->model, impl_->cycle_time, settings);
  }
  return {};
}

void Arm::end_force_mode()
{
  if (!impl_->force) {
    return;
  }
  const bool stopping = impl_->braking();
  impl_->force.reset();
  if (stopping) {
    return;
  }
  impl_->setpoint = impl_->commanded;
  if (impl_->motion() != nullptr || !impl_->setpoint.velocity.isZero(0.0)) {
    impl_->brake_hard(end_deceleration);
  }
}

bool Arm::in_force_mode() const
{
  return impl_->force.has_value();
}

void Arm::set_force_mode_scaling(double scaling)
{
  impl_->force_scaling = scaling;
}

void Arm::set_force_mode_damping(double damping)
{
  impl_->force_damping = damping;
}

void Arm::Impl::drop_deviation()
{
  setpoint = commanded;
  if (force) {
    const ForceModeSettings settings = force->settings();
    force.emplace(model, cycle_time, settings);
  }
}

void Arm::Impl::take_over_joints()
{
  commanded = {follower.position(), follower.velocity()};
  setpoint = commanded;
}

void Arm::Impl::comply(const Tick & tick)
{
  const auto found = force->advance(setpoint, *state, force_scaling, force_damping, paused, commanded);
  if (!found) {
    if (motion() == nullptr) {
      force->fold(*state, setpoint);
    }
    return;
  }
  if (!fault) {
    fault = found;
  }
  brake_hard(fault_deceleration);
  motion()->advance(tick, setpoint);
  commanded = setpoint;
}

void Arm::Impl::lead_joints(const Tick & tick)
{
  const Motion * running = motion();
  const bool by_itself = running != nullptr && running->leads_actual();
  if (force && may_move() && !braking() && !by_itself) {
    comply(tick);
  } else {
    commanded = setpoint;
  }
  if (by_itself) {
    follower.match(setpoint.position, setpoint.velocity);
  } else {
    follower.advance(commanded.position);
  }
}

MotionStart Arm::freedrive(const std::array<bool, 6> & free_axes, const Vector6 & feature)
{
  constexpr std::string_view call = "freedrive_mode";
  if (impl_->force) {
    return tl::unexpected(fmt::format("{}: the arm is in force mode: call end_force_mode() first", call));
  }
  const Refusal refusal = impl_->guided()
                              ? not_finite(call, "feature", feature)
                              : first_of({impl_->not_ready(call), not_finite(call, "feature", feature)});
  if (refusal) {
    return tl::unexpected(*refusal);
  }
  impl_->take_over_joints();
  return impl_->begin(Freedrive(impl_->model, impl_->dynamics, *impl_->state, free_axes, feature));
}

void Arm::end_freedrive()
{
  if (impl_->guided()) {
    abandon_all();
  }
}

MotionStart Arm::direct_torque(const Vector6 & torque, const Vector6 & viscous_scale,
                               const Vector6 & coulomb_scale)
{
  constexpr std::string_view call = "direct_torque";
  Refusal refusal = first_of({impl_->not_ready(call), not_finite(call, "torque", torque),
                              not_finite(call, "viscous_scale", viscous_scale),
                              not_finite(call, "coulomb_scale", coulomb_scale)});
  for (Eigen::Index i = 0; i < 6 && !refusal; ++i) {
    const double most = impl_->model.torque_max[i];
    refusal = first_of({not_within(call, fmt::format("torque[{}]", i), torque[i], -most, most),
                        not_within(call, fmt::format("viscous_scale[{}]", i), viscous_scale[i], 0.0, 1.0),
                        not_within(call, fmt::format("coulomb_scale[{}]", i), coulomb_scale[i], 0.0, 1.0)});
  }
  if (refusal) {
    return tl::unexpected(*refusal);
  }
  if (!std::holds_alternative<TorqueControl>(impl_->slot)) {
    impl_->take_over_joints();
  }
  return impl_->begin(
      TorqueControl(impl_->model, impl_->dynamics, *impl_->state, torque, viscous_scale, coulomb_scale));
}

void Arm::end_program()
{
  end_force_mode();
  end_freedrive();
  impl_->force_scaling = default_force_scaling;
  impl_->force_damping = default_force_damping;
}

}  // namespace ur_simulator
