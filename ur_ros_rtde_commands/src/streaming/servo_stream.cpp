#include "streaming/servo_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "ur_ros_rtde_robot/connection/realtime_priority.hpp"

namespace ur_ros_rtde {
namespace {

using trajectory::Joints;
using trajectory::Limits;
using trajectory::TimeScaling;
using trajectory::Trajectory;

/// s. Lower limit of the time that the arm takes to follow a setpoint.
constexpr double min_servo_lag = 0.1;
constexpr double lag_reserve = 0.1;    // s, beyond lookahead_time
constexpr double stopped_rate = 0.01;  // the rate below which braking is not necessary
constexpr std::chrono::milliseconds stop_planning_timeout{4};
constexpr std::chrono::seconds package_timeout{1};
constexpr double servo_stop_deceleration = 5.0;  // rad/s^2; the arm is already at rest

/// The motion at a rate of the time axis.
JointMotion scaled(const trajectory::Point & point, const TimeScaling & time_scaling)
{
  const double rate = time_scaling.rate();
  return {point.position, point.velocity * rate,
          point.acceleration * (rate * rate) + point.velocity * time_scaling.rate_dot()};
}

}  // namespace

ServoStream::ServoStream(Run & run, ServoSettings settings, SetpointCallback on_setpoint)
    : run_(run),
      settings_(std::move(settings)),
      on_setpoint_(std::move(on_setpoint)),
      cycle_(run.robot().cycle_time()),
      clock_(cycle_),
      target_(trajectory::joint_count)
{
  state_.sample = run.state();
}

TimeScaling ServoStream::make_time_scaling(double rate, double time) const
{
  const TimeScaling::Servo servo{.cycle = cycle_,
                                 .lag = std::max(settings_.parameters.lookahead_time, min_servo_lag),
                                 .bridged_cycles = SetpointClock::bridged_cycles,
                                 .lead = settings_.parameters.lookahead_time};
  return TimeScaling(servo, rate, time);
}

Outcome ServoStream::execute(const Trajectory & plan, const Limits & limits)
{
  const RealtimePriority priority(run_.robot().realtime_priority());
  const Run::Braking braking = run_.brake_by_itself();
  state_.sample = run_.state();
  const Joints end = plan.sample(plan.duration()).position;
  std::copy(end.begin(), end.end(), target_.begin());
  TimeScaling time_scaling = make_time_scaling(state_.sample.requested_rate());
  // The control program extrapolates from the last two setpoints on its way, so both are the end of the plan.
  for (bool at_end = time_scaling.time() >= plan.duration(); !at_end;) {
    at_end = clock_.is_at_end(time_scaling.time() - plan.duration());
    const double before = state_.sample.controller_time;
    const auto stop_reason = run_.next(state_.sample);
    add_elapsed(before);
    time_scaling.advance(elapsed_, state_.sample.requested_rate(), plan.sample(time_scaling.time()), limits);
    if (stop_reason) {
      brake(braking, plan, limits, time_scaling);
      return *stop_reason;
    }
    if (Status sent = send(plan, limits, time_scaling); !sent) {
      return sent;
    }
    if (Status going_on = on_setpoint_(plan, state_); !going_on) {
      return going_on;
    }
  }
  return Outcome::success();
}

void ServoStream::add_elapsed(double before)
{
  elapsed_ = clock_.advance(state_.sample, state_.sample.controller_time - before);
}

Status ServoStream::send(const Trajectory & plan, const Limits & limits, const TimeScaling & time_scaling)
{
  state_.time = std::min(time_scaling.time(), plan.duration());
  state_.desired = scaled(plan.sample(state_.time), time_scaling);
  const ServoParameters & servo = settings_.parameters;
  const Joints setpoint = servo_setpoint(state_.desired, servo, limits);
  std::copy(setpoint.begin(), setpoint.end(), target_.begin());
  run_.control()->servoJ(target_, 0.0, 0.0, cycle_, servo.lookahead_time, servo.gain, clock_.time());
  update_tracking_error();
  if (state_.tracking_error > settings_.max_tracking_error) {
    return failure(ErrorCode::not_reached,
                   fmt::format("the arm is {:.4f} rad behind the trajectory {:.2f} s after its start, "
                               "max_tracking_error is {:.4f} rad: check for obstacles and a low gain",
                               state_.tracking_error, state_.time, settings_.max_tracking_error));
  }
  return {};
}

void ServoStream::update_tracking_error()
{
  const Sample & sample = state_.sample;
  const double oldest = sample.controller_time - settings_.parameters.lookahead_time - lag_reserve;
  targets_.push_back({sample.controller_time, state_.desired.position, state_.desired.velocity});
  while (targets_.front().controller_time < oldest) {
    targets_.pop_front();
  }
  const Joints here = Eigen::Map<const Joints>(sample.actual_q.data());
  state_.tracking_error = std::numeric_limits<double>::infinity();
  for (const Target & target : targets_) {
    const double distance = (target.position - here).abs().maxCoeff();
    if (distance < state_.tracking_error) {
      state_.tracking_error = distance;
      state_.position_error = target.position - here;
      state_.velocity_error = target.velocity - Eigen::Map<const Joints>(sample.actual_qd.data());
    }
  }
  max_tracking_error_ = std::max(max_tracking_error_, state_.tracking_error);
}

bool ServoStream::next_package()
{
  const double before = state_.sample.controller_time;
  const auto deadline = std::chrono::steady_clock::now() + package_timeout;
  while (std::chrono::steady_clock::now() < deadline && run_.may_brake()) {
    if (run_.robot().wait_for_next(state_.sample, std::chrono::milliseconds(10))) {
      add_elapsed(before);
      return run_.may_brake();
    }
  }
  return false;
}

void ServoStream::brake(const Run::Braking & braking, const Trajectory & plan, const Limits & limits,
                        const TimeScaling & time_scaling)
{
  const double rate = time_scaling.rate();
  if (rate <= stopped_rate || !run_.may_brake()) {
    return;
  }
  const double time = time_scaling.time() / rate;
  const auto deadline = std::chrono::steady_clock::now() + stop_planning_timeout;
  if (const auto stop = plan.slowed(rate).stop_from(time, limits, deadline)) {
    follow(braking, *stop, limits, time);
  } else {
    slow_down(braking, plan, limits, time_scaling);
  }
}

void ServoStream::follow(const Run::Braking & braking, const Trajectory & stop, const Limits & limits,
                         double time)
{
  TimeScaling time_scaling = make_time_scaling(1.0, time);
  while (time_scaling.time() < stop.duration() && next_package()) {
    time_scaling.advance(elapsed_, 1.0, stop.sample(time_scaling.time()), limits);
    if (!send(stop, limits, time_scaling)) {
      return;
    }
    braking.sent();
    (void)on_setpoint_(stop, state_);  // the goal ends already
  }
}

void ServoStream::slow_down(const Run::Braking & braking, const Trajectory & plan, const Limits & limits,
                            TimeScaling time_scaling)
{
  while (time_scaling.rate() > 0.0 && time_scaling.time() < plan.duration() && next_package()) {
    time_scaling.advance(elapsed_, 0.0, plan.sample(time_scaling.time()), limits);
    if (!send(plan, limits, time_scaling)) {
      return;
    }
    braking.sent();
    (void)on_setpoint_(plan, state_);
  }
}

Outcome ServoStream::finish()
{
  const Outcome arrived = run_.until_at_rest_at_joints(target_);
  if (arrived) {
    run_.control()->servoStop(servo_stop_deceleration);
  }
  return arrived;
}

}  // namespace ur_ros_rtde
