#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/pose.hpp"
#include "motion/arm_impl.hpp"

namespace ur_simulator {
namespace {

constexpr double scaling_rate =
    2.0;  // 1/s: the scaling follows a step of the slider from 0 to 1 within 0.5 s
// s, from recordings of robots: the speed of movej and movel grows with the square of the time at first.
constexpr double start_ramp = 0.16;
constexpr double max_servo_error = 0.2;  // rad: a larger error triggers a protective stop

}  // namespace

void Arm::Impl::ramp_speed_scaling(ControllerState & current)
{
  const double slider =
      std::isfinite(current.speed_slider) ? std::clamp(current.speed_slider, 0.0, 1.0) : 0.0;
  current.target_speed_fraction = slider;
  const bool ends = canceled && current_motion() != nullptr;  // it does not become faster: a stop of a pause
  const double allowed = paused ? 0.0 : slider;
  const double target = ends ? std::min(allowed, current.speed_scaling) : allowed;
  const double step = scaling_rate * cycle_time;
  current.speed_scaling += std::clamp(target - current.speed_scaling, -step, step);
  start_scaling = std::min(start_scaling + cycle_time / start_ramp, 1.0);
}

TimeStep Arm::Impl::time_step(const ControllerState & current) const
{
  const bool is_path = std::holds_alternative<PathMotion>(active_motion);
  return {cycle_time, current.speed_scaling * (is_path ? start_scaling : 1.0)};
}

void Arm::begin_program()
{
  impl_->start_scaling = impl_->setpoint.velocity.isZero(0.0) ? 0.0 : 1.0;
}

void Arm::Impl::replace_with_stop(double deceleration)
{
  reset_deviation();
  active_motion = JointSpeedMotion::stop(model, deceleration);
  canceled = true;
  is_stop = true;
}

Arm::Arm(const RobotModel & model, double cycle_time, const Vector6 & initial_position)
{
  if (!(std::isfinite(cycle_time) && cycle_time > 0.0)) {
    throw std::invalid_argument(fmt::format("Arm: cycle time must be greater than 0, is {}", cycle_time));
  }
  if (const auto rejection = first_rejection({check_finite("Arm", "position", initial_position),
                                              check_joint_limits("Arm", model, initial_position)})) {
    throw std::invalid_argument(*rejection);
  }
  impl_ = std::make_unique<Impl>(model, cycle_time, initial_position);
}

Arm::~Arm() = default;

StartResult Arm::servo_joint(const Vector6 & target, double time, double lookahead, double gain)
{
  if (const auto rejection =
          first_rejection({impl_->check_ready("servoj"), check_finite("servoj", "target", target),
                           check_in_range("servoj", "time", time, 0.0, 1e9),
                           check_in_range("servoj", "lookahead_time", lookahead, 0.03, 0.2),
                           check_in_range("servoj", "gain", gain, 100.0, 2000.0),
                           check_joint_limits("servoj", impl_->model, target)})) {
    return tl::unexpected(*rejection);
  }
  return impl_->start_motion(JointServoMotion(impl_->model, target, time, lookahead, gain));
}

StartResult Arm::speed_joint(const Vector6 & velocity, double acceleration, double time)
{
  if (const auto rejection =
          first_rejection({impl_->check_ready("speedj"), check_finite("speedj", "velocity", velocity),
                           check_positive("speedj", "acceleration", acceleration),
                           check_in_range("speedj", "time", time, 0.0, 1e9)})) {
    return tl::unexpected(*rejection);
  }
  return impl_->start_motion(JointSpeedMotion(impl_->model, velocity, acceleration, time));
}

StartResult Arm::speed_linear(const Vector6 & tcp_twist, double acceleration, double time,
                              std::optional<double> rotational_acceleration)
{
  const double rotational = rotational_acceleration.value_or(acceleration);
  if (const auto rejection = first_rejection(
          {impl_->check_ready("speedl"), check_finite("speedl", "velocity", tcp_twist),
           check_positive("speedl", "acceleration", acceleration),
           check_positive("speedl", "aRot", rotational), check_in_range("speedl", "time", time, 0.0, 1e9)})) {
    return tl::unexpected(*rejection);
  }
  return impl_->start_motion(
      LinearSpeedMotion(impl_->tcp_kinematics(), impl_->setpoint, tcp_twist, acceleration, rotational, time));
}

StartResult Arm::stop_joint(double deceleration)
{
  if (impl_->in_freedrive()) {
    return skipped_motion_id;  // the program has no motion to stop
  }
  if (const auto rejection = first_rejection(
          {impl_->check_ready("stopj"), check_positive("stopj", "deceleration", deceleration)})) {
    return tl::unexpected(*rejection);
  }
  return impl_->start_motion(JointSpeedMotion::stop(impl_->model, deceleration), true);
}

StartResult Arm::stop_linear(double deceleration, std::optional<double> rotational_deceleration)
{
  const double rotational = rotational_deceleration.value_or(deceleration);
  if (impl_->in_freedrive()) {
    return skipped_motion_id;
  }
  if (const auto rejection =
          first_rejection({impl_->check_ready("stopl"), check_positive("stopl", "deceleration", deceleration),
                           check_positive("stopl", "aRot", rotational)})) {
    return tl::unexpected(*rejection);
  }
  return impl_->start_motion(LinearSpeedMotion(impl_->tcp_kinematics(), impl_->setpoint, Vector6::Zero(),
                                               deceleration, rotational, 0.0),
                             true);
}

bool Arm::call_complete(MotionId motion) const
{
  const Motion * running = impl_->current_motion();
  return motion != impl_->last_id || running == nullptr || impl_->canceled || running->call_complete();
}

bool Arm::active(MotionId motion) const
{
  return motion == impl_->last_id && impl_->current_motion() != nullptr &&
         !(impl_->canceled && impl_->is_stop);
}

void Arm::cancel(MotionId motion)
{
  if (motion == impl_->last_id) {
    cancel_all();
    impl_->is_ended_by_program = true;
  }
}

void Arm::cancel_all()
{
  if (Motion * running = impl_->current_motion()) {
    running->decelerate();
    impl_->canceled = true;
  }
}

void Arm::stop_all(double deceleration)
{
  const bool valid = std::isfinite(deceleration) && deceleration > 0.0;
  impl_->replace_with_stop(valid ? deceleration : fault_deceleration);
}

bool Arm::at_rest(double tolerance) const
{
  return impl_->current_motion() == nullptr && impl_->setpoint.velocity.isZero(0.0) &&
         impl_->servo_loop.velocity().isZero(tolerance);
}

void Arm::pause()
{
  impl_->paused = true;
  const bool speed_motion = std::holds_alternative<JointSpeedMotion>(impl_->active_motion) ||
                            std::holds_alternative<LinearSpeedMotion>(impl_->active_motion) ||
                            impl_->in_freedrive();
  if (speed_motion) {
    cancel_all();  // no path that the speed scaling could stop
  }
}

void Arm::resume()
{
  impl_->paused = false;
}

std::optional<MotionFault> Arm::take_fault()
{
  return std::exchange(impl_->fault, std::nullopt);
}

void Arm::Impl::advance(const TimeStep & time_step)
{
  Motion * running = current_motion();
  if (running == nullptr) {
    return;
  }
  if (const auto found = running->advance(time_step, setpoint)) {
    if (!is_stop && !fault) {
      fault = found;
    }
    replace_with_stop(fault_deceleration);
    running = current_motion();
    running->advance(time_step, setpoint);
  }
  if (running->finished()) {
    last_reached_id = canceled ? last_reached_id : last_id;
    active_motion = std::monostate();
  }
}

void Arm::Impl::count_broken_motion(const ControllerState & current)
{
  const Motion * running = current_motion();
  const bool ends =
      running != nullptr && !is_stop && (is_ended_by_program || (!canceled && running->is_unattended()));
  if (ends && !has_lapse && moves() && current.runtime_state == RuntimeState::playing) {
    has_lapse = true;
    ++lapses.broken_off;
  }
}

void Arm::step(ControllerState & state)
{
  Impl & arm = *impl_;
  arm.state = &state;
  arm.count_broken_motion(state);
  arm.ramp_speed_scaling(state);
  if (state.robot_mode != RobotMode::running) {
    // The mechanical brakes hold the arm.
    arm.active_motion = std::monostate();
    arm.servo_loop.hold();
    arm.commanded = {arm.servo_loop.position(), Vector6::Zero()};
    arm.reset_deviation();
  } else {
    if (!arm.may_move() && arm.current_motion() != nullptr && !(arm.is_stop && arm.canceled)) {
      arm.replace_with_stop(fault_deceleration);
    }
    const TimeStep time_step = arm.time_step(state);
    arm.advance(time_step);
    arm.command_joints(time_step);
  }
  const auto * path = std::get_if<PathMotion>(&arm.active_motion);
  state.time_scale_source = path != nullptr && path->limited_by_joint_speed()
                                ? TimeScaleSource::joint_speed_limit
                                : TimeScaleSource::none;
  state.lapses = arm.lapses;
  state.freedrive = arm.in_freedrive();
  state.in_force_mode = arm.force.has_value();
  state.joint_deviation_ratio =
      (arm.commanded.position - arm.servo_loop.position()).cwiseAbs().maxCoeff() / max_servo_error;
  arm.writer.write(arm.path_offset.enabled() && !arm.force ? arm.commanded : arm.setpoint, arm.servo_loop,
                   state);
  arm.write_path(state);
}

void Arm::Impl::write_path(ControllerState & current)
{
  if (path_offset.enabled()) {
    const TcpKinematics kinematics = tcp_kinematics();
    current.path_tcp_pose = to_pose(kinematics.tcp_pose(setpoint.position));
    current.path_tcp_speed = kinematics.tcp_twist(setpoint);
  } else {
    current.path_tcp_pose = current.target_tcp_pose;
    current.path_tcp_speed = current.target_tcp_speed;
  }
}

void Arm::teleport(const Vector6 & position, ControllerState & state)
{
  if (const auto rejection = first_rejection({check_finite("teleport", "position", position),
                                              check_joint_limits("teleport", impl_->model, position)})) {
    throw std::invalid_argument(*rejection);
  }
  impl_->active_motion = std::monostate();
  impl_->commanded = {position, Vector6::Zero()};
  impl_->reset_deviation();
  impl_->servo_loop.jump_to(position);
  impl_->state = &state;
  impl_->writer.reset();
  impl_->writer.write(impl_->setpoint, impl_->servo_loop, state);
  impl_->write_path(state);
}

}  // namespace ur_simulator
