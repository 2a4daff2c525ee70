#include <algorithm>
#include <optional>

#include "trajectory/motion.hpp"
#include "trajectory/slow_clock.hpp"
#include "trajectory/verify.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

// The place on the planned piece `index` that the slowed clock shows when its r'' is `bend`.
Place slowed_place(const Motion & plan, std::size_t index, const ClockState & clock, double bend)
{
  const TimePiece & piece = plan.timing[index];
  const Place place = piece.at(std::clamp(clock.planned, piece.start, piece.end()));
  const double r = clock.rate;
  return {place.u, place.v * r, place.a * r * r + place.v * clock.change,
          place.j * r * r * r + 3.0 * place.a * r * clock.change + place.v * bend};
}

// Ends of the parts in which both the plan and the clock are smooth.
std::vector<double> part_ends(const Motion & plan, const SlowClock & clock)
{
  std::vector<double> ends;
  for (std::size_t k = 1; k < clock.phases.size(); ++k) {
    ends.push_back(clock.phases[k].begin);
  }
  const double landing = clock.phases.back().begin;
  constexpr int landing_parts = 16;
  for (int k = 1; k <= landing_parts; ++k) {
    ends.push_back(landing + (clock.end - landing) * k / landing_parts);
  }
  const double last = clock.at(clock.end).planned;
  for (std::size_t i = plan.piece_at(clock.phases.front().state.planned); plan.timing[i].end() < last; ++i) {
    ends.push_back(clock.when(plan.timing[i].end()));
  }
  std::sort(ends.begin(), ends.end());
  return ends;
}

// The braking alone, its time from 0.
Motion braking(const Motion & plan, const SlowClock & clock)
{
  constexpr double shortest = 1e-9;  // s; shorter parts are joined with the next
  Motion result;
  result.path = plan.path;
  double from = 0.0;
  for (const double to : part_ends(plan, clock)) {
    if (to - from < shortest) {
      continue;
    }
    const double middle = 0.5 * (from + to);
    const double bend = clock.bend_at(middle);
    const std::size_t index = plan.piece_at(clock.at(middle).planned);
    const Place begin = slowed_place(plan, index, clock.at(from), bend);
    result.append(plan.timing[index].piece, to - from, begin, slowed_place(plan, index, clock.at(to), bend));
    from = to;
  }
  return result;
}

// The quickest braking that obeys the limits everywhere: the less of them it means to use, the less it
// exceeds them between the moments that the search looks at.
std::optional<Motion> find_braking(const Motion & plan, double planned, const Limits & limits)
{
  for (const double reserve : {0.0, 0.02, 0.06, 0.15, 0.3, 0.5, 0.7, 0.85}) {
    const auto clock = find_slow_clock(plan, planned, limits, reserve);
    if (!clock) {
      continue;
    }
    Motion motion = braking(plan, *clock);
    Utilisation use;
    if (!first_excess(motion, limits, verification_step, use)) {
      return motion;
    }
  }
  return std::nullopt;
}

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
  // Should no braking from here pass its verification, one that begins a little later does.
  constexpr double wait = 0.025;  // s
  std::optional<Motion> brake;
  double begin = now;
  for (; begin < duration(); begin += wait) {
    brake = find_braking(*motion_, begin, slightly_within(limits, 5e-5));
    if (brake) {
      break;
    }
  }
  if (!brake) {
    return *this;
  }
  const std::size_t index = motion_->piece_at(begin);
  result->timing.assign(motion_->timing.begin(),
                        motion_->timing.begin() + static_cast<std::ptrdiff_t>(index) + 1);
  result->timing.back().duration = begin - result->timing.back().start;
  for (TimePiece piece : brake->timing) {
    piece.start = result->duration();
    result->timing.push_back(piece);
  }
  return Trajectory(std::move(result));
}

}  // namespace ur_ros_rtde::trajectory
