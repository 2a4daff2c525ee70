#include "streaming/servo_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <limits>

#include "ur_ros_rtde_robot/connection/realtime_priority.hpp"

namespace ur_ros_rtde {
namespace {

using trajectory::Joints;
using trajectory::Limits;
using trajectory::StreamClock;
using trajectory::Trajectory;

/// s: how fast the arm slows down when its target stands still, at least.
constexpr double least_memory = 0.1;
constexpr double following_reserve = 0.1;  // s, beyond lookahead_time
constexpr double standing = 0.01;          // a rate below which there is nothing left to brake
constexpr std::chrono::seconds package_limit{1};
constexpr double servo_stop_deceleration = 5.0;  // m/s^2; the arm stands already

double cycle_of(const Robot & robot)
{
  const auto version = robot.version();
  return 1.0 / (version ? version->frequency() : 500.0);
}

/// The lesser of both: controllers differ in whether the one contains the other.
double wanted_rate(const Sample & sample)
{
  return std::clamp(std::min(sample.speed_scaling, sample.target_speed_fraction), 0.0, 1.0);
}

}  // namespace

ServoStream::ServoStream(Run & run, ServoSettings settings, Watch watch)
    : run_(run),
      settings_(std::move(settings)),
      watch_(std::move(watch)),
      cycle_(cycle_of(run.robot())),
      memory_(std::max(settings_.lookahead_time, least_memory)),
      target_(trajectory::joint_count)
{
  state_.sample = run.state();
}

Outcome ServoStream::drive(const Trajectory & plan, const Limits & limits)
{
  const RealtimePriority priority(run_.robot().realtime_priority());
  state_.sample = run_.state();
  const Joints end = plan.sample(plan.duration()).position;
  std::copy(end.begin(), end.end(), target_.begin());
  StreamClock clock(cycle_, memory_, wanted_rate(state_.sample));
  while (clock.time() < plan.duration()) {
    const double before = state_.sample.controller_time;
    if (const auto why = run_.next(state_.sample)) {
      elapsed_ = state_.sample.controller_time - before;
      brake(plan, limits, clock);
      return *why;
    }
    elapsed_ = state_.sample.controller_time - before;
    clock.advance(elapsed_, wanted_rate(state_.sample), plan.sample(clock.time()), limits);
    if (Status sent = send(plan, clock.time()); !sent) {
      return sent;
    }
  }
  return Outcome::success();
}

Status ServoStream::send(const Trajectory & plan, double time)
{
  state_.time = std::min(time, plan.duration());
  state_.desired = plan.sample(state_.time);
  std::copy(state_.desired.position.begin(), state_.desired.position.end(), target_.begin());
  run_.control()->servoJ(target_, 0.0, 0.0, cycle_, settings_.lookahead_time, settings_.gain);
  measure();
  if (state_.tracking_error > settings_.max_tracking_error) {
    return failure(ErrorCode::not_reached,
                   fmt::format("the arm is {:.4f} rad behind the trajectory {:.2f} s after its beginning, "
                               "max_tracking_error is {:.4f} rad: is something in the way, or the gain low?",
                               state_.tracking_error, state_.time, settings_.max_tracking_error));
  }
  return watch_(plan, state_);
}

void ServoStream::measure()
{
  const Sample & sample = state_.sample;
  const double oldest = sample.controller_time - settings_.lookahead_time - following_reserve;
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
  largest_error_ = std::max(largest_error_, state_.tracking_error);
}

bool ServoStream::next_package()
{
  const double before = state_.sample.controller_time;
  const auto deadline = std::chrono::steady_clock::now() + package_limit;
  while (std::chrono::steady_clock::now() < deadline && run_.robot().motion_possible()) {
    if (run_.robot().wait_for_next(state_.sample, std::chrono::milliseconds(10))) {
      elapsed_ = state_.sample.controller_time - before;
      return static_cast<bool>(run_.robot().motion_possible());
    }
  }
  return false;
}

bool ServoStream::keep_going(const Trajectory & plan, const Limits & limits, StreamClock & clock,
                             const std::function<bool()> & enough)
{
  while (clock.time() < plan.duration() && !enough()) {
    if (!next_package()) {
      return false;
    }
    clock.advance(elapsed_, clock.rate(), plan.sample(clock.time()), limits);
    if (!send(plan, clock.time())) {
      return false;
    }
  }
  return true;
}

/// The stop is searched for in a thread of its own, the arm goes on meanwhile: it is a part of the same plan
/// up to a moment `ahead`. Should the search take longer, it begins again farther ahead.
void ServoStream::brake(const Trajectory & plan, const Limits & limits, StreamClock & clock)
{
  for (double ahead = 0.02; ahead < 1.0 && clock.rate() > standing; ahead *= 4.0) {
    if (settings_.stopped_by_another() || !run_.robot().motion_possible()) {
      return;
    }
    const double rate = clock.rate();
    const double from = clock.time() + ahead * rate;
    auto search = std::async(std::launch::async, [&plan, &limits, rate, from] {
      return plan.slowed(rate).stop_from(from / rate, limits);
    });
    const auto found = [&] { return search.wait_for(std::chrono::seconds(0)) == std::future_status::ready; };
    if (!keep_going(plan, limits, clock, found)) {
      return;
    }
    const Trajectory stop = search.get();
    if (clock.time() <= from) {
      StreamClock braking(cycle_, memory_, 1.0, clock.time() / rate);
      keep_going(stop, limits, braking, settings_.stopped_by_another);
      return;
    }
  }
}

Outcome ServoStream::settle()
{
  const Outcome arrived = run_.until_at_joints(target_);
  if (arrived) {
    run_.control()->servoStop(servo_stop_deceleration);
  }
  return arrived;
}

}  // namespace ur_ros_rtde
