#include <algorithm>
#include <cmath>
#include <optional>

#include "trajectory/motion.hpp"
#include "trajectory/verify.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

constexpr double wait_step = 0.008;   // s, between the moments at which braking may begin
constexpr int fit_pieces = 24;        // of the stop, at least
constexpr double check_step = 0.004;  // s

// A stop slows the clock of the planned motion: its time runs at rate 1 - (3 x^2 - 2 x^3), x = t / length
// from 0 to 1. So the arm stays on its path, and starts to brake without a jump of the acceleration.
struct Clock {
  double begin;   // planned time when the braking begins
  double length;  // s

  double time(double t) const
  {
    const double x = t / length;
    return begin + length * (x - x * x * x + 0.5 * x * x * x * x);
  }
  double rate(double t) const
  {
    const double x = t / length;
    return 1.0 - x * x * (3.0 - 2.0 * x);
  }
  double change(double t) const
  {
    const double x = t / length;
    return -6.0 * x * (1.0 - x) / length;
  }
  // When the clock shows `planned`, begin < planned < time(length).
  double when(double planned) const
  {
    double low = 0.0;
    double high = length;
    for (int round = 0; round < 60; ++round) {
      const double middle = 0.5 * (low + high);
      (time(middle) < planned ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
};

// The planned place, by the slowed clock, on the planned piece `index`.
Place slowed_place(const Motion & plan, std::size_t index, const Clock & clock, double t)
{
  const TimePiece & piece = plan.timing[index];
  const Place place = piece.at(std::clamp(clock.time(t), piece.start, piece.end()));
  const double rate = clock.rate(t);
  return {place.u, place.v * rate, place.a * rate * rate + place.v * clock.change(t), 0.0};
}

// The braking part alone, its time from 0.
Motion braking(const Motion & plan, const Clock & clock)
{
  Motion result;
  result.path = plan.path;
  const double last_planned = std::min(clock.time(clock.length), plan.duration());
  const double end = last_planned < clock.time(clock.length) ? clock.when(last_planned) : clock.length;
  const double step = clock.length / fit_pieces;
  double from = 0.0;
  std::size_t index = plan.piece_at(clock.begin);
  while (from < end) {
    double to = std::min(from + step, end);
    const double border = plan.timing[index].end();
    const bool crosses = border < last_planned && clock.time(to) >= border;
    if (crosses) {
      to = std::clamp(clock.when(border), from, to);
    }
    if (to - from > 1e-9) {
      result.append(plan.timing[index].piece, to - from, slowed_place(plan, index, clock, from),
                    slowed_place(plan, index, clock, to));
      from = to;
    } else if (!crosses) {
      break;
    }
    index += crosses ? 1 : 0;
  }
  return result;
}

// Longest braking worth a try: four times what the joints need from full speed.
double longest_braking(const Limits & limits)
{
  const Joints ramp = limits.velocity / limits.acceleration;
  const Joints settle = limits.acceleration / limits.jerk;
  return 4.0 * (ramp + settle).maxCoeff();
}

class StopSearch {
 public:
  StopSearch(const Motion & plan, Limits limits) : plan_(plan), limits_(std::move(limits)) {}

  // The stop from `time` on that is at rest first; none when the plan itself comes to rest before any.
  std::optional<Clock> find(double time)
  {
    best_end_ = plan_.duration();
    const double longest = longest_braking(limits_);
    for (double begin = time; begin < best_end_; begin += wait_step) {
      const double room = std::min(longest, best_end_ - begin);
      if (obeys({begin, room})) {
        shorten(begin, room);
      }
    }
    return best_;
  }

 private:
  bool obeys(const Clock & clock) const
  {
    Utilisation use;
    return !first_excess(braking(plan_, clock), limits_, check_step, use);
  }

  void shorten(double begin, double feasible)
  {
    double infeasible = 0.0;
    while (feasible - infeasible > 0.02 * feasible) {
      const double middle = 0.5 * (feasible + infeasible);
      (obeys({begin, middle}) ? feasible : infeasible) = middle;
    }
    best_ = Clock{begin, feasible};
    best_end_ = begin + feasible;
  }

  const Motion & plan_;
  Limits limits_;
  double best_end_ = 0.0;
  std::optional<Clock> best_;
};

}  // namespace

Trajectory Trajectory::stop_from(double time, const Limits & limits) const
{
  if (!(time < duration())) {
    return *this;
  }
  const double now = std::max(time, 0.0);
  auto result = std::make_shared<Motion>();
  result->path = motion_->path;
  if (now <= 0.0) {
    result->append(motion_->timing.front().piece, 1e-3, Place{});  // not yet begun: stay
    return Trajectory(std::move(result));
  }
  const auto clock = StopSearch(*motion_, slightly_within(limits, 5e-5)).find(now);
  if (!clock) {
    return *this;
  }
  const std::size_t index = motion_->piece_at(clock->begin);
  result->timing.assign(motion_->timing.begin(),
                        motion_->timing.begin() + static_cast<std::ptrdiff_t>(index) + 1);
  result->timing.back().duration = clock->begin - result->timing.back().start;
  for (TimePiece piece : braking(*motion_, *clock).timing) {
    piece.start = result->duration();
    result->timing.push_back(piece);
  }
  return Trajectory(std::move(result));
}

}  // namespace ur_ros_rtde::trajectory
