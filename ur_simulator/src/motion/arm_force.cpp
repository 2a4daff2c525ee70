#include <cmath>

#include "motion/arm_impl.hpp"

namespace ur_simulator {
namespace {

constexpr double compliance_stop_deceleration = 4.0;  // rad/s^2

Rejection check_force_mode_settings(const ForceModeSettings & settings)
{
  constexpr std::string_view function = "force_mode";
  if (auto rejection = first_rejection({check_finite(function, "task_frame", settings.frame),
                                        check_finite(function, "wrench", settings.wrench),
                                        check_finite(function, "limits", settings.limits)})) {
    return rejection;
  }
  for (Eigen::Index i = 0; i < 6; ++i) {
    if (auto rejection =
            check_in_range(function, fmt::format("limits[{}]", i), settings.limits[i], 0.0, 1e9)) {
      return rejection;
    }
  }
  return std::nullopt;
}

}  // namespace

tl::expected<void, std::string> Arm::start_force_mode(const ForceModeSettings & settings)
{
  if (const auto rejection =
          first_rejection({impl_->check_ready("force_mode"), check_force_mode_settings(settings)})) {
    return tl::unexpected(*rejection);
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
  const bool stopping = impl_->stopping();
  impl_->force.reset();
  if (stopping) {
    return;
  }
  impl_->setpoint = impl_->commanded;
  if (impl_->current_motion() != nullptr || !impl_->setpoint.velocity.isZero(0.0)) {
    impl_->replace_with_stop(compliance_stop_deceleration);
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

double Arm::force_mode_scaling() const
{
  return impl_->force_scaling;
}

double Arm::force_mode_damping() const
{
  return impl_->force_damping;
}

void Arm::Impl::reset_deviation()
{
  setpoint = commanded;
  path_offset.restart();
  if (force) {
    const ForceModeSettings settings = force->settings();
    force.emplace(model, cycle_time, settings);
  }
}

void Arm::Impl::start_from_actual_joints()
{
  commanded = {servo_loop.position(), servo_loop.velocity()};
  setpoint = commanded;
}

void Arm::Impl::apply_force_mode(const TimeStep & time_step)
{
  const auto found = force->advance(setpoint, *state, force_scaling, force_damping, paused, commanded);
  if (!found) {
    if (current_motion() == nullptr) {
      force->absorb_deviation(*state, setpoint);
    }
    return;
  }
  stop_with_fault(*found, time_step);
}

void Arm::Impl::apply_path_offset(const TimeStep & time_step)
{
  const TcpKinematics kinematics = tcp_kinematics();
  const Transform tcp =
      path_offset.apply(kinematics.tcp_pose(setpoint.position), kinematics.tcp_twist(setpoint).head<3>());
  if (const auto found = kinematics.move_to(tcp, cycle_time, commanded)) {
    stop_with_fault(*found, time_step);
  }
}

void Arm::Impl::stop_with_fault(const MotionFault & found, const TimeStep & time_step)
{
  if (!fault) {
    fault = found;
  }
  replace_with_stop(fault_deceleration);
  current_motion()->advance(time_step, setpoint);
  commanded = setpoint;
}

void Arm::Impl::command_joints(const TimeStep & time_step)
{
  const Motion * running = current_motion();
  const bool controls_actual = running != nullptr && running->controls_actual_joints();
  if (force && may_move() && !stopping() && !controls_actual) {
    apply_force_mode(time_step);
  } else if (path_offset.enabled() && may_move() && !stopping() && !controls_actual) {
    apply_path_offset(time_step);
  } else {
    commanded = setpoint;
  }
  if (controls_actual) {
    servo_loop.set_state(setpoint.position, setpoint.velocity);
  } else {
    servo_loop.advance(commanded.position);
  }
}

StartResult Arm::start_freedrive(const std::array<bool, 6> & free_axes, const Vector6 & feature)
{
  constexpr std::string_view function = "freedrive_mode";
  if (impl_->force) {
    return tl::unexpected(fmt::format("{}: the arm is in force mode: call end_force_mode() first", function));
  }
  const Rejection rejection =
      impl_->in_freedrive()
          ? check_finite(function, "feature", feature)
          : first_rejection({impl_->check_ready(function), check_finite(function, "feature", feature)});
  if (rejection) {
    return tl::unexpected(*rejection);
  }
  impl_->start_from_actual_joints();
  return impl_->start_motion(
      FreedriveMotion(impl_->model, impl_->dynamics, *impl_->state, free_axes, feature));
}

void Arm::end_freedrive()
{
  if (impl_->in_freedrive()) {
    cancel_all();
  }
}

StartResult Arm::direct_torque(const Vector6 & torque, const Vector6 & viscous_scale,
                               const Vector6 & coulomb_scale)
{
  constexpr std::string_view function = "direct_torque";
  Rejection rejection =
      first_rejection({impl_->check_ready(function), check_finite(function, "torque", torque),
                       check_finite(function, "viscous_scale", viscous_scale),
                       check_finite(function, "coulomb_scale", coulomb_scale)});
  for (Eigen::Index i = 0; i < 6 && !rejection; ++i) {
    const double max_torque = impl_->model.torque_max[i];
    rejection = first_rejection(
        {check_in_range(function, fmt::format("torque[{}]", i), torque[i], -max_torque, max_torque),
         check_in_range(function, fmt::format("viscous_scale[{}]", i), viscous_scale[i], 0.0, 1.0),
         check_in_range(function, fmt::format("coulomb_scale[{}]", i), coulomb_scale[i], 0.0, 1.0)});
  }
  if (rejection) {
    return tl::unexpected(*rejection);
  }
  if (!std::holds_alternative<TorqueMotion>(impl_->active_motion)) {
    impl_->start_from_actual_joints();
  }
  return impl_->start_motion(
      TorqueMotion(impl_->model, impl_->dynamics, *impl_->state, torque, viscous_scale, coulomb_scale));
}

PathOffset & Arm::path_offset()
{
  return impl_->path_offset;
}

void Arm::disable_path_offset()
{
  if (impl_->path_offset.enabled()) {
    impl_->path_offset.disable();
    impl_->setpoint = impl_->commanded;
  }
}

void Arm::end_program()
{
  end_force_mode();
  if (impl_->path_offset.enabled()) {
    impl_->replace_with_stop(compliance_stop_deceleration);
  }
  impl_->path_offset = PathOffset();
  end_freedrive();
  impl_->force_scaling = default_force_scaling;
  impl_->force_damping = default_force_damping;
}

}  // namespace ur_simulator
