#include "trajectory/braking_time_scaling.hpp"

#include <algorithm>
#include <cmath>

namespace ur_ros_rtde::trajectory {
namespace {

constexpr double shortest_step = 0.005;  // s
constexpr double steps_per_ramp = 20.0;  // of the deceleration, from zero to its largest value
constexpr int max_recovery_steps = 400;

struct RateDdotRange {
  double low = -1e9;
  double high = 1e9;
};

class BrakingSearch {
 public:
  using Clock = std::chrono::steady_clock;

  BrakingSearch(const Motion & plan, const Limits & limits, double reserve, Clock::time_point deadline)
      : plan_(plan),
        acceleration_(limits.acceleration),
        jerk_(limits.jerk),
        usable_fraction_(1.0 - reserve),
        deadline_(deadline)
  {
  }

  std::optional<BrakingTimeScaling> find(double plan_time)
  {
    TimeScalingState state{plan_time, 1.0, 0.0};
    step_ = step_at(plan_time);
    double time = 0.0;
    double recovery = 0.0;  // first rate_ddot of the recovery to a constant rate
    best_end_ = plan_.duration() - plan_time;
    while (time < best_end_ && state.plan_time < plan_.duration()) {
      if (Clock::now() > deadline_) {
        return std::nullopt;
      }
      try_final_phase(time, state);
      const double rate_ddot = hardest_braking(state, recovery);
      scaling_.phases.push_back({time, rate_ddot, state});
      state = state.after(step_, rate_ddot);
      time += step_;
    }
    return best_;
  }

 private:
  // The more gently the limits let the rate change, the longer the steps, so that the number of steps does
  // not depend on the limits.
  double step_at(double plan_time) const
  {
    const Joints speed = plan_point(plan_time).velocity.abs().max(1e-9);
    const double rate_dot = (acceleration_ / speed).minCoeff();
    const double rate_ddot = (jerk_ / speed).minCoeff();
    const double ramp = std::min(rate_dot / rate_ddot, std::sqrt(1.0 / rate_ddot));
    return std::max(shortest_step, ramp / steps_per_ramp);
  }

  // r' that the acceleration limits allow. With high jerk limits, one step must not lead beyond it.
  double lowest_rate_dot(const TimeScalingState & s) const
  {
    const Point p = plan_point(s.plan_time);
    const Joints own = p.acceleration * (s.rate * s.rate) * p.velocity.sign();
    return -((usable_fraction_ * acceleration_ + own) / p.velocity.abs().max(1e-9)).minCoeff();
  }

  Point plan_point(double plan_time) const
  {
    const TimingLawPiece & piece = plan_.timing[plan_.piece_at(plan_time)];
    const PathState path_state = piece.at(std::clamp(plan_time, piece.start, piece.end()));
    const PathPiece & curve = plan_.path->pieces[piece.piece];
    return joint_motion(curve.at(std::clamp(path_state.u, 0.0, curve.length)), path_state);
  }

  // Range of r'' within the jerk limits. Empty (low > high) if an acceleration limit is exceeded.
  RateDdotRange feasible_rate_ddot(const TimeScalingState & s) const
  {
    const Point p = plan_point(s.plan_time);
    const double r2 = s.rate * s.rate;
    RateDdotRange result;
    const Joints acceleration = p.acceleration * r2 + p.velocity * s.rate_dot;
    // The acceleration of the scaled plan itself is always allowed, so a constant rate is always feasible.
    const Joints max_acceleration = (usable_fraction_ * acceleration_).max((p.acceleration * r2).abs());
    if (s.rate < 0.0 || s.rate > 1.0 || (acceleration.abs() > max_acceleration).any()) {
      return {1.0, -1.0};
    }
    const Joints jerk = p.jerk * (r2 * s.rate) + p.acceleration * (3.0 * s.rate * s.rate_dot);
    const Joints max_jerk = (usable_fraction_ * jerk_).max((p.jerk * (r2 * s.rate)).abs());
    for (int j = 0; j < joint_count; ++j) {
      const double speed = std::abs(p.velocity[j]);
      if (speed * 1e9 <= max_jerk[j]) {
        if (std::abs(jerk[j]) > max_jerk[j]) {
          return {1.0, -1.0};
        }
        continue;
      }
      const double middle = p.velocity[j] > 0.0 ? -jerk[j] / speed : jerk[j] / speed;
      result.low = std::max(result.low, middle - max_jerk[j] / speed);
      result.high = std::min(result.high, middle + max_jerk[j] / speed);
    }
    return result;
  }

  // Whether r'' = rate_ddot keeps the limits for `time`. Checks three moments, including both sides of a
  // discontinuity of the jerk of the plan.
  bool keeps_limits(const TimeScalingState & s, double rate_ddot, double time) const
  {
    for (const double part : {0.02, 0.5, 0.98}) {
      const RateDdotRange allowed = feasible_rate_ddot(s.after(part * time, rate_ddot));
      if (rate_ddot < allowed.low || rate_ddot > allowed.high) {
        return false;
      }
    }
    return true;
  }

  // Whether the rate can become constant before it reaches zero. `first`: r'' of the first step.
  bool can_recover(TimeScalingState s, double & first) const
  {
    first = 0.0;
    for (int k = 0; k < max_recovery_steps && Clock::now() <= deadline_; ++k) {
      if (s.rate_dot >= -1e-9) {
        return true;
      }
      const RateDdotRange allowed = feasible_rate_ddot(s);
      const double highest = std::min(allowed.high, -s.rate_dot / step_);
      double rate_ddot = highest;
      bool found = false;
      for (const double fraction : {0.98, 0.8, 0.5, 0.2}) {
        rate_ddot = highest * fraction;
        found = rate_ddot >= allowed.low && keeps_limits(s, rate_ddot, step_);
        if (found) {
          break;
        }
      }
      const TimeScalingState next = s.after(step_, rate_ddot);
      if (!found || next.rate < 0.0) {
        return false;
      }
      first = k == 0 ? rate_ddot : first;
      // A remaining r' that one step can remove counts as zero.
      s = next;
      if (s.rate_dot > -1e-4) {
        s.rate_dot = 0.0;
      }
    }
    return false;
  }

  // Lowest r'' for the next step that keeps the limits and allows a recovery to a constant rate. `recovery`
  // is the first r'' of the recovery from this state, and receives that of the next state.
  double hardest_braking(const TimeScalingState & s, double & recovery) const
  {
    const double low = std::max(feasible_rate_ddot(s).low, (lowest_rate_dot(s) - s.rate_dot) / step_);
    double next_recovery = 0.0;
    for (const double fraction : {0.98, 0.8, 0.6, 0.4, 0.25, 0.12, 0.05, 0.02}) {
      const double rate_ddot = low + (1.0 - fraction) * std::max(0.0, recovery - low);
      if (rate_ddot < recovery && keeps_limits(s, rate_ddot, step_) &&
          can_recover(s.after(step_, rate_ddot), next_recovery)) {
        recovery = next_recovery;
        return rate_ddot;
      }
    }
    const double rate_ddot = recovery;
    can_recover(s.after(step_, rate_ddot), recovery);
    return rate_ddot;
  }

  // Final phase to rest with constant r''. Accepted if it keeps the limits and ends sooner than the best so
  // far.
  void try_final_phase(double time, const TimeScalingState & s)
  {
    if (s.rate_dot >= 0.0) {
      return;
    }
    const double length = 2.0 * s.rate / -s.rate_dot;
    const double rate_ddot = s.rate_dot * s.rate_dot / (2.0 * s.rate);
    if (time + length >= best_end_) {
      return;
    }
    const int parts = std::max(4, static_cast<int>(std::ceil(length / step_)));
    for (int k = 0; k < parts; ++k) {
      for (const double offset : {0.01, 0.5, 0.99}) {
        const RateDdotRange allowed = feasible_rate_ddot(s.after(length * (k + offset) / parts, rate_ddot));
        if (rate_ddot < allowed.low || rate_ddot > allowed.high) {
          return;
        }
      }
    }
    best_ = scaling_;
    best_->phases.push_back({time, rate_ddot, s});
    best_->end = best_end_ = time + length;
  }

  const Motion & plan_;
  Joints acceleration_, jerk_;
  double usable_fraction_;
  Clock::time_point deadline_;
  double step_ = shortest_step;  // s
  BrakingTimeScaling scaling_;
  std::optional<BrakingTimeScaling> best_;
  double best_end_ = 0.0;
};

}  // namespace

const BrakingTimeScaling::Phase & BrakingTimeScaling::phase_at(double time) const
{
  const auto after = std::upper_bound(phases.begin(), phases.end(), time,
                                      [](double value, const Phase & phase) { return value < phase.begin; });
  return after == phases.begin() ? phases.front() : *(after - 1);
}

TimeScalingState BrakingTimeScaling::at(double time) const
{
  const Phase & phase = phase_at(time);
  TimeScalingState state = phase.state.after(std::min(time, end) - phase.begin, phase.rate_ddot);
  if (time >= end) {
    state.rate = state.rate_dot = 0.0;
  }
  return state;
}

double BrakingTimeScaling::time_at(double plan_time) const
{
  double low = 0.0;
  double high = end;
  for (int round = 0; round < 60; ++round) {
    const double middle = 0.5 * (low + high);
    (at(middle).plan_time < plan_time ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::optional<BrakingTimeScaling> find_braking_time_scaling(const Motion & plan, double plan_time,
                                                            const Limits & limits, double reserve,
                                                            std::chrono::steady_clock::time_point deadline)
{
  return BrakingSearch(plan, limits, reserve, deadline).find(plan_time);
}

}  // namespace ur_ros_rtde::trajectory
