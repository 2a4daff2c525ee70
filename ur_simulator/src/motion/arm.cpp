#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/pose.hpp"
#include "motion/arm_impl.hpp"

namespace ur_simulator {
namespace {

constexpr double scaling_rate = 2.0;  // 1/s: a slider moved from 0 to 1 takes half a second to take effect

}  // namespace

void Arm::Impl::ramp_scaling(ControllerState & current) const
{
  const double slider =
      std::isfinite(current.speed_slider) ? std::clamp(current.speed_slider, 0.0, 1.0) : 0.0;
  current.target_speed_fraction = paused ? 0.0 : slider;
  const double step = scaling_rate * cycle_time;
  current.speed_scaling += std::clamp(current.target_speed_fraction - current.speed_scaling, -step, step);
}

void Arm::Impl::brake_hard(double deceleration)
{
  drop_deviation();
  slot = JointSpeed::stop(model, deceleration);
  given_up = true;
  is_stop = true;
}

Arm::Arm(const RobotModel & model, double cycle_time, const Vector6 & initial_position)
{
  if (!(std::isfinite(cycle_time) && cycle_time > 0.0)) {
    throw std::invalid_argument(fmt::format("Arm: cycle time must be greater than 0, is {}", cycle_time));
  }
  if (const auto refusal = first_of({not_finite("Arm", "position", initial_position),
                                     beyond_joint_limits("Arm", model, initial_position)})) {
    throw std::invalid_argument(*refusal);
  }
  impl_ = std::make_unique<Impl>(model, cycle_time, initial_position);
}

Arm::~Arm() = default;

MotionStart Arm::servo_joint(const Vector6 & target, double time, double lookahead, double gain)
{
  if (const auto refusal = first_of({impl_->not_ready("servoj"), not_finite("servoj", "target", target),
                                     not_within("servoj", "time", time, 0.0, 1e9),
                                     not_within("servoj", "lookahead_time", lookahead, 0.03, 0.2),
                                     not_within("servoj", "gain", gain, 100.0, 2000.0),
                                     beyond_joint_limits("servoj", impl_->model, target)})) {
    return tl::unexpected(*refusal);
  }
  return impl_->begin(JointServo(impl_->model, target, time, lookahead, gain));
}

MotionStart Arm::speed_joint(const Vector6 & velocity, double acceleration, double time)
{
  if (const auto refusal = first_of({impl_->not_ready("speedj"), not_finite("speedj", "velocity", velocity),
                                     not_positive("speedj", "acceleration", acceleration),
                                     not_within("speedj", "time", time, 0.0, 1e9)})) {
    return tl::unexpected(*refusal);
  }
  return impl_->begin(JointSpeed(impl_->model, velocity, acceleration, time));
}

MotionStart Arm::speed_linear(const Vector6 & tcp_twist, double acceleration, double time)
{
  if (const auto refusal = first_of({impl_->not_ready("speedl"), not_finite("speedl", "velocity", tcp_twist),
                                     not_positive("speedl", "acceleration", acceleration),
                                     not_within("speedl", "time", time, 0.0, 1e9)})) {
    return tl::unexpected(*refusal);
  }
  return impl_->begin(LinearSpeed(impl_->path(), impl_->setpoint, tcp_twist, acceleration, time));
}

MotionStart Arm::stop_joint(double deceleration)
{
  if (impl_->guided()) {
    return skipped_motion;  // there is nothing that the program moves
  }
  if (const auto refusal =
          first_of({impl_->not_ready("stopj"), not_positive("stopj", "deceleration", deceleration)})) {
    return tl::unexpected(*refusal);
  }
  return impl_->begin(JointSpeed::stop(impl_->model, deceleration), true);
}

MotionStart Arm::stop_linear(double deceleration)
{
  if (impl_->guided()) {
    return skipped_motion;
  }
  if (const auto refusal =
          first_of({impl_->not_ready("stopl"), not_positive("stopl", "deceleration", deceleration)})) {
    return tl::unexpected(*refusal);
  }
  return impl_->begin(LinearSpeed(impl_->path(), impl_->setpoint, Vector6::Zero(), deceleration, 0.0), true);
}

bool Arm::finished(MotionId motion) const
{
  const Motion * running = impl_->motion();
  return motion != impl_->last_id || running == nullptr || impl_->given_up || running->released();
}

bool Arm::active(MotionId motion) const
{
  return motion == impl_->last_id && impl_->motion() != nullptr && !(impl_->given_up && impl_->is_stop);
}

void Arm::abandon(MotionId motion)
{
  if (motion == impl_->last_id) {
    abandon_all();
  }
}

void Arm::abandon_all()
{
  if (Motion * running = impl_->motion()) {
    running->brake();
    impl_->given_up = true;
  }
}

void Arm::halt(double deceleration)
{
  const bool sane = std::isfinite(deceleration) && deceleration > 0.0;
  impl_->brake_hard(sane ? deceleration : fault_deceleration);
}

bool Arm::at_rest() const
{
  return impl_->motion() == nullptr && impl_->setpoint.velocity.isZero(0.0) &&
         impl_->follower.velocity().isZero(1e-6);
}

void Arm::pause()
{
  impl_->paused = true;
  const bool by_speed = std::holds_alternative<JointSpeed>(impl_->slot) ||
                        std::holds_alternative<LinearSpeed>(impl_->slot) || impl_->guided();
  if (by_speed) {
    abandon_all();  // it follows no path in time that could stand still
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

void Arm::Impl::advance(const Tick & tick)
{
  Motion * running = motion();
  if (running == nullptr) {
    return;
  }
  if (const auto found = running->advance(tick, setpoint)) {
    if (!is_stop && !fault) {
      fault = found;
    }
    brake_hard(fault_deceleration);
    running = motion();
    running->advance(tick, setpoint);
  }
  if (running->done()) {
    last_arrived = given_up ? last_arrived : last_id;
    slot = std::monostate();
  }
}

void Arm::step(ControllerState & state)
{
  Impl & arm = *impl_;
  arm.state = &state;
  arm.ramp_scaling(state);
  if (state.robot_mode != RobotMode::running) {
    // The brakes are on: whatever was moving stands where it is.
    arm.slot = std::monostate();
    arm.follower.freeze();
    arm.commanded = {arm.follower.position(), Vector6::Zero()};
    arm.drop_deviation();
  } else {
    if (!arm.may_move() && arm.motion() != nullptr && !(arm.is_stop && arm.given_up)) {
      arm.brake_hard(fault_deceleration);
    }
    const Tick tick{arm.cycle_time, state.speed_scaling};
    arm.advance(tick);
    arm.lead_joints(tick);
  }
  state.freedrive = arm.guided();
  state.in_force_mode = arm.force.has_value();
  arm.writer.write(arm.setpoint, arm.follower, state);
}

void Arm::teleport(const Vector6 & position, ControllerState & state)
{
  if (const auto refusal = first_of({not_finite("teleport", "position", position),
                                     beyond_joint_limits("teleport", impl_->model, position)})) {
    throw std::invalid_argument(*refusal);
  }
  impl_->slot = std::monostate();
  impl_->commanded = {position, Vector6::Zero()};
  impl_->drop_deviation();
  impl_->follower.jump_to(position);
  impl_->state = &state;
  impl_->writer.forget();
  impl_->writer.write(impl_->setpoint, impl_->follower, state);
}

}  // namespace ur_simulator
