#include "trajectory/slow_clock.hpp"

#include <algorithm>
#include <cmath>

namespace ur_ros_rtde::trajectory {
namespace {

constexpr double clock_step = 0.005;  // s
constexpr int longest_return = 400;   // steps

struct Range {
  double low = -1e9;
  double high = 1e9;
};

class Search {
 public:
  Search(const Motion & plan, const Limits & limits, double reserve)
      : plan_(plan), acceleration_(limits.acceleration), jerk_(limits.jerk), usable_(1.0 - reserve)
  {
  }

  std::optional<SlowClock> find(double planned)
  {
    ClockState state{planned, 1.0, 0.0};
    double time = 0.0;
    double way_back = 0.0;  // the bend with which the way back to a constant rate begins
    best_end_ = plan_.duration() - planned;
    while (time < best_end_ && state.planned < plan_.duration()) {
      consider_landing(time, state);
      const double bend = hardest(state, way_back);
      clock_.phases.push_back({time, bend, state});
      state = state.after(clock_step, bend);
      time += clock_step;
    }
    return best_;
  }

 private:
  Point planned_point(double planned) const
  {
    const TimePiece & piece = plan_.timing[plan_.piece_at(planned)];
    const Place place = piece.at(std::clamp(planned, piece.start, piece.end()));
    const PathPiece & curve = plan_.path->pieces[piece.piece];
    return at_place(curve.at(std::clamp(place.u, 0.0, curve.length)), place);
  }

  // The r'' that the jerk limits allow; empty (low > high) when an acceleration limit is exceeded.
  Range range(const ClockState & s) const
  {
    const Point p = planned_point(s.planned);
    const double r2 = s.rate * s.rate;
    Range result;
    const Joints acceleration = p.acceleration * r2 + p.velocity * s.change;
    // What the slowed plan itself uses is always allowed: so a constant rate always is.
    const Joints most = (usable_ * acceleration_).max((p.acceleration * r2).abs());
    if (s.rate < 0.0 || s.rate > 1.0 || (acceleration.abs() > most).any()) {
      return {1.0, -1.0};
    }
    const Joints jerk = p.jerk * (r2 * s.rate) + p.acceleration * (3.0 * s.rate * s.change);
    const Joints most_jerk = (usable_ * jerk_).max((p.jerk * (r2 * s.rate)).abs());
    for (int j = 0; j < joint_count; ++j) {
      const double speed = std::abs(p.velocity[j]);
      if (speed * 1e9 <= most_jerk[j]) {
        if (std::abs(jerk[j]) > most_jerk[j]) {
          return {1.0, -1.0};
        }
        continue;
      }
      const double middle = p.velocity[j] > 0.0 ? -jerk[j] / speed : jerk[j] / speed;
      result.low = std::max(result.low, middle - most_jerk[j] / speed);
      result.high = std::min(result.high, middle + most_jerk[j] / speed);
    }
    return result;
  }

  // Whether r'' = bend keeps the limits for `time`, seen at three moments: where the plan's jerk jumps, on
  // both sides.
  bool keeps(const ClockState & s, double bend, double time) const
  {
    for (const double part : {0.02, 0.5, 0.98}) {
      const Range allowed = range(s.after(part * time, bend));
      if (bend < allowed.low || bend > allowed.high) {
        return false;
      }
    }
    return true;
  }

  // From this state the rate can become constant before it is zero. `first`: the bend of the first step.
  bool can_return(ClockState s, double & first) const
  {
    first = 0.0;
    for (int k = 0; k < longest_return; ++k) {
      if (s.change >= -1e-9) {
        return true;
      }
      const Range allowed = range(s);
      const double highest = std::min(allowed.high, -s.change / clock_step);
      double bend = highest;
      bool found = false;
      for (const double share : {0.98, 0.8, 0.5, 0.2}) {
        bend = highest * share;
        found = bend >= allowed.low && keeps(s, bend, clock_step);
        if (found) {
          break;
        }
      }
      const ClockState next = s.after(clock_step, bend);
      if (!found || next.rate < 0.0) {
        return false;
      }
      first = k == 0 ? bend : first;
      // The remaining change fades away: a rest of it that one step could take away is none.
      s = next;
      if (s.change > -1e-4) {
        s.change = 0.0;
      }
    }
    return false;
  }

  // The lowest bend for the next step that keeps the limits and leaves a way back. `way_back` holds the
  // bend that begins the way back from here, and receives that of the next state.
  double hardest(const ClockState & s, double & way_back) const
  {
    const Range allowed = range(s);
    double next_way_back = 0.0;
    for (const double share : {0.98, 0.8, 0.6, 0.4, 0.25, 0.12, 0.05, 0.02}) {
      const double bend = allowed.low + (1.0 - share) * std::max(0.0, way_back - allowed.low);
      if (bend < way_back && keeps(s, bend, clock_step) &&
          can_return(s.after(clock_step, bend), next_way_back)) {
        way_back = next_way_back;
        return bend;
      }
    }
    const double bend = way_back;
    can_return(s.after(clock_step, bend), way_back);
    return bend;
  }

  // From here to rest with constant r'', when that keeps the limits and ends sooner than the best so far.
  void consider_landing(double time, const ClockState & s)
  {
    if (s.change >= 0.0) {
      return;
    }
    const double length = 2.0 * s.rate / -s.change;
    const double bend = s.change * s.change / (2.0 * s.rate);
    if (time + length >= best_end_) {
      return;
    }
    const int parts = std::max(4, static_cast<int>(std::ceil(length / clock_step)));
    for (int k = 0; k < parts; ++k) {
      for (const double offset : {0.01, 0.5, 0.99}) {
        const Range allowed = range(s.after(length * (k + offset) / parts, bend));
        if (bend < allowed.low || bend > allowed.high) {
          return;
        }
      }
    }
    best_ = clock_;
    best_->phases.push_back({time, bend, s});
    best_->end = best_end_ = time + length;
  }

  const Motion & plan_;
  Joints acceleration_, jerk_;
  double usable_;
  SlowClock clock_;
  std::optional<SlowClock> best_;
  double best_end_ = 0.0;
};

}  // namespace

const SlowClock::Phase & SlowClock::phase_at(double time) const
{
  const auto after = std::upper_bound(phases.begin(), phases.end(), time,
                                      [](double value, const Phase & phase) { return value < phase.begin; });
  return after == phases.begin() ? phases.front() : *(after - 1);
}

ClockState SlowClock::at(double time) const
{
  const Phase & phase = phase_at(time);
  ClockState state = phase.state.after(std::min(time, end) - phase.begin, phase.bend);
  if (time >= end) {
    state.rate = state.change = 0.0;
  }
  return state;
}

double SlowClock::when(double planned) const
{
  double low = 0.0;
  double high = end;
  for (int round = 0; round < 60; ++round) {
    const double middle = 0.5 * (low + high);
    (at(middle).planned < planned ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::optional<SlowClock> find_slow_clock(const Motion & plan, double planned, const Limits & limits,
                                         double reserve)
{
  return Search(plan, limits, reserve).find(planned);
}

}  // namespace ur_ros_rtde::trajectory
