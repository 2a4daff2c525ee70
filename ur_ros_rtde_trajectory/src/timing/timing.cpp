#include "timing/timing.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>

#include "path/straight.hpp"
#include "timing/first_guess.hpp"
#include "timing/jerk_solver.hpp"
#include "timing/reach.hpp"
#include "trajectory/verify.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

constexpr int inner_points = 3;  // looked at between two stations
constexpr double most_stations = 50000;
constexpr double shortest_station_step = 0.002;  // s, between stations

double sum(const std::vector<double> & values)
{
  double total = 0.0;
  for (const double value : values) {
    total += value;
  }
  return total;
}

Grid coarse_grid(const Path & path, std::size_t first, std::size_t last)
{
  return uniform_grid(path, first, last, std::clamp<std::size_t>(1500 / (last - first), 4, 12));
}

}  // namespace

void slow_to_limits(Motion & motion, std::size_t begin, const Limits & limits)
{
  constexpr double margin = 3e-4;  // for what happens between the points looked at
  const Utilisation use = largest_use(motion, begin, limits);
  const double factor = std::max({use.velocity, std::sqrt(use.acceleration), std::cbrt(use.jerk)});
  if (factor > 1.0 - 0.5 * margin) {
    motion.stretch(factor * (1.0 + margin), begin);
  }
}

namespace {

// Takes back what `motion` (its pieces from `begin`, one per interval) uses too much. False when there is
// nothing.
bool tighten(const Motion & motion, std::size_t begin, const Limits & limits, Allowance & allowance)
{
  bool found = false;
  for (std::size_t i = 0; i < allowance.jerk.size(); ++i) {
    const PieceUse use = use_of(motion, motion.timing[begin + i], limits, inner_points);
    const double jerk = use.jerk.maxCoeff();
    const double acceleration = use.acceleration.maxCoeff();
    if (jerk > 1.002) {
      allowance.jerk[i] = std::max(0.3, allowance.jerk[i] / jerk * 0.999);
      found = true;
    }
    if (acceleration > 1.002) {
      for (const std::size_t m : {i, i + 1}) {
        allowance.acceleration[m] = std::max(0.3, std::min(allowance.acceleration[m], 0.999 / acceleration));
      }
      found = true;
    }
  }
  return found;
}

Grid grid_for_jerk(const Path & path, std::size_t first, std::size_t last, const Limits & limits)
{
  const Grid coarse = coarse_grid(path, first, last);
  const Profile guess = fastest_without_jerk(coarse, limits);
  const double total = sum(guess.time);
  const double jerk_time = (limits.acceleration / limits.jerk).minCoeff();
  const double step =
      std::min(std::max({0.3 * jerk_time, shortest_station_step, total / most_stations}), total / 100.0);
  return timed_grid(path, coarse, guess, step, 6);
}

// Divides the intervals of `motion` (its pieces from `begin`, one per interval) in which a limit is exceeded
// between the stations. Returns the new grid and the same motion on it; no grid when there is nothing to
// divide.
std::optional<std::pair<Grid, Profile>> divide(const Motion & motion, std::size_t begin, const Grid & grid,
                                               const Limits & limits)
{
  std::pair<Grid, Profile> result;
  auto & [fine, profile] = result;
  fine.reserve(grid.intervals() * 3 / 2);
  profile.v.push_back(0.0);
  profile.alpha.push_back(0.0);
  for (std::size_t i = 0; i < grid.intervals(); ++i) {
    const TimePiece & piece = motion.timing[begin + i];
    const PieceUse use = use_of(motion, piece, limits, inner_points);
    const double worst = std::max(use.jerk.maxCoeff(), use.acceleration.maxCoeff());
    const bool rest = i == 0 || i + 1 == grid.intervals();
    const int parts = rest || worst < 1.03 ? 1 : worst < 1.3 ? 2 : 3;
    double from = grid.begin[i];
    for (int k = 1; k <= parts; ++k) {
      const Place place = piece.at(piece.start + piece.duration * k / parts);
      const double to = k == parts ? grid.end[i] : std::clamp(place.u, from, grid.end[i]);
      fine.add(*motion.path, grid.piece[i], from, to);
      profile.v.push_back(place.v);
      profile.alpha.push_back(place.a);
      profile.time.push_back(piece.duration / parts);
      from = to;
    }
  }
  profile.v.back() = profile.alpha.back() = 0.0;
  return fine.intervals() > grid.intervals() ? std::optional(std::move(result)) : std::nullopt;
}

// Of the motion's pieces from `begin` on.
Profile profile_of(const Motion & motion, std::size_t begin)
{
  Profile profile;
  for (std::size_t k = begin; k < motion.timing.size(); ++k) {
    const Place place = motion.timing[k].at(motion.timing[k].start);
    profile.v.push_back(place.v);
    profile.alpha.push_back(place.a);
    profile.time.push_back(motion.timing[k].duration);
  }
  profile.v.push_back(0.0);
  profile.alpha.push_back(0.0);
  return profile;
}

// One grid's solution, appended to the motion. Gaps: how near to the optimum, for one speed spline after the
// other.
Profile solve_on(const Grid & grid, Start start, double away, const Limits & limits,
                 const Allowance & allowance, std::initializer_list<double> gaps)
{
  SpeedSpline spline(grid, start.profile);
  JerkSolver solver(grid, limits, allowance);
  solver.start(spline, std::move(start.w), away);
  Profile profile;
  for (const double gap : gaps) {
    if (!profile.v.empty()) {
      spline = SpeedSpline(grid, profile);
      solver.change_spline(spline);
    }
    solver.improve(profile.v.empty() ? 40 : 20, gap);
    profile = spline.profile(grid, solver.coefficients());
  }
  return profile;
}

void append_jerk_limited(Motion & motion, std::size_t first, std::size_t last, const Limits & limits)
{
  Grid grid = grid_for_jerk(*motion.path, first, last, limits);
  const std::size_t begin = motion.timing.size();
  const auto take = [&](const Profile & profile) {
    motion.timing.resize(begin);
    motion.append(grid, profile, false);
  };
  take(solve_on(grid, first_guess(grid, limits), 4.0, limits, Allowance(grid), {0.1, 0.02}));
  for (int round = 0; round < 2; ++round) {
    if (auto finer = divide(motion, begin, grid, limits)) {
      grid = std::move(finer->first);
      take(solve_on(grid, start_from(grid, std::move(finer->second)), 0.3, limits, Allowance(grid), {0.02}));
    }
  }
  Allowance allowance(grid);
  for (int round = 0; round < 3; ++round) {
    if (!tighten(motion, begin, limits, allowance) && round > 0) {
      break;
    }
    take(solve_on(grid, start_from(grid, profile_of(motion, begin)), 0.1, limits, allowance, {0.004}));
  }
  slow_to_limits(motion, begin, limits);
}

void append_fastest(Motion & motion, std::size_t first, std::size_t last, const Limits & limits)
{
  const Grid coarse = coarse_grid(*motion.path, first, last);
  const Profile guess = fastest_without_jerk(coarse, limits);
  const double step = std::max(sum(guess.time) / most_stations, 0.005);
  const Grid grid = timed_grid(*motion.path, coarse, guess, std::min(step, sum(guess.time) / 50.0), 12);
  const std::size_t begin = motion.timing.size();
  motion.append(grid, fastest_without_jerk(grid, limits), true);
  slow_to_limits(motion, begin, limits);
}

}  // namespace

void time_block(Motion & motion, std::size_t first, std::size_t last, const Limits & limits)
{
  if (motion.path->length() <= 0.0) {
    return;  // a path of one point
  }
  const Limits inner = slightly_within(limits);
  if (last - first == 1 && motion.path->pieces[first].straight()) {
    append_straight_motion(motion, first, inner);
  } else if (limits.has_jerk()) {
    append_jerk_limited(motion, first, last, inner);
  } else {
    append_fastest(motion, first, last, inner);
  }
}

}  // namespace ur_ros_rtde::trajectory
