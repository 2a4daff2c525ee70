#include "timing/segment_timing.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>

#include "timing/initial_timing.hpp"
#include "timing/jerk_solver.hpp"
#include "timing/s_curve_profile.hpp"
#include "timing/topp_ra.hpp"
#include "trajectory/verify.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

constexpr int inner_points = 3;  // verified points between two stations
constexpr double max_stations = 50000;
constexpr double min_station_step = 0.002;  // s, between stations

double total_time(const std::vector<double> & values)
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
  constexpr double margin = 3e-4;  // for violations between the verified points
  const Utilization use = max_utilization(motion, begin, limits);
  const double factor = std::max({use.velocity, std::sqrt(use.acceleration), std::cbrt(use.jerk)});
  if (factor > 1.0 - 0.5 * margin) {
    motion.stretch(factor * (1.0 + margin), begin);
  }
}

namespace {

// Tightens the limits where `motion` exceeds them (pieces from `begin`, one per interval). Returns false if
// it exceeds none.
bool tighten_limits(const Motion & motion, std::size_t begin, const Limits & limits,
                    LimitFractions & limit_fractions)
{
  bool found = false;
  for (std::size_t i = 0; i < limit_fractions.jerk.size(); ++i) {
    const PieceUtilization use = piece_utilization(motion, motion.timing[begin + i], limits, inner_points);
    const double jerk = use.jerk.maxCoeff();
    const double acceleration = use.acceleration.maxCoeff();
    if (jerk > 1.002) {
      limit_fractions.jerk[i] = std::max(0.3, limit_fractions.jerk[i] / jerk * 0.999);
      found = true;
    }
    if (acceleration > 1.002) {
      for (const std::size_t m : {i, i + 1}) {
        limit_fractions.acceleration[m] =
            std::max(0.3, std::min(limit_fractions.acceleration[m], 0.999 / acceleration));
      }
      found = true;
    }
  }
  return found;
}

Grid jerk_limited_grid(const Path & path, std::size_t first, std::size_t last, const Limits & limits)
{
  const Grid coarse = coarse_grid(path, first, last);
  const Profile estimate = solve_topp_ra(coarse, limits);
  const double total = total_time(estimate.time);
  const double jerk_time = (limits.acceleration / limits.jerk).minCoeff();
  const double step =
      std::min(std::max({0.3 * jerk_time, min_station_step, total / max_stations}), total / 100.0);
  return time_spaced_grid(path, coarse, estimate, step, 6);
}

// Subdivides the intervals of `motion` (pieces from `begin`, one per interval) in which a limit is exceeded
// between the stations. Returns the new grid and the same motion on it, or nullopt if no interval is
// subdivided.
std::optional<std::pair<Grid, Profile>> subdivide(const Motion & motion, std::size_t begin, const Grid & grid,
                                                  const Limits & limits)
{
  std::pair<Grid, Profile> result;
  auto & [fine, profile] = result;
  fine.reserve(grid.intervals() * 3 / 2);
  profile.v.push_back(0.0);
  profile.alpha.push_back(0.0);
  for (std::size_t i = 0; i < grid.intervals(); ++i) {
    const TimingLawPiece & piece = motion.timing[begin + i];
    const PieceUtilization use = piece_utilization(motion, piece, limits, inner_points);
    const double worst = std::max(use.jerk.maxCoeff(), use.acceleration.maxCoeff());
    const bool rest = i == 0 || i + 1 == grid.intervals();
    const int parts = rest || worst < 1.03 ? 1 : worst < 1.3 ? 2 : 3;
    double from = grid.begin[i];
    for (int k = 1; k <= parts; ++k) {
      const PathState path_state = piece.at(piece.start + piece.duration * k / parts);
      const double to = k == parts ? grid.end[i] : std::clamp(path_state.u, from, grid.end[i]);
      fine.add(*motion.path, grid.piece[i], from, to);
      profile.v.push_back(path_state.v);
      profile.alpha.push_back(path_state.a);
      profile.time.push_back(piece.duration / parts);
      from = to;
    }
  }
  profile.v.back() = profile.alpha.back() = 0.0;
  return fine.intervals() > grid.intervals() ? std::optional(std::move(result)) : std::nullopt;
}

// Profile of the pieces of `motion` from `begin` on.
Profile profile_of(const Motion & motion, std::size_t begin)
{
  Profile profile;
  for (std::size_t k = begin; k < motion.timing.size(); ++k) {
    const PathState path_state = motion.timing[k].at(motion.timing[k].start);
    profile.v.push_back(path_state.v);
    profile.alpha.push_back(path_state.a);
    profile.time.push_back(motion.timing[k].duration);
  }
  profile.v.push_back(0.0);
  profile.alpha.push_back(0.0);
  return profile;
}

// Solves on one grid. `gaps`: the optimality gaps for successive speed splines.
Profile solve_on_grid(const Grid & grid, InitialTiming start, double initial_gap, const Limits & limits,
                      const LimitFractions & limit_fractions, std::initializer_list<double> gaps)
{
  SpeedSpline spline(grid, start.profile);
  JerkSolver solver(grid, limits, limit_fractions);
  solver.start(spline, std::move(start.w), initial_gap);
  Profile profile;
  for (const double gap : gaps) {
    if (!profile.v.empty()) {
      spline = SpeedSpline(grid, profile);
      solver.set_spline(spline);
    }
    solver.iterate(profile.v.empty() ? 40 : 20, gap);
    profile = spline.profile(grid, solver.coefficients());
  }
  return profile;
}

void append_jerk_limited(Motion & motion, std::size_t first, std::size_t last, const Limits & limits)
{
  Grid grid = jerk_limited_grid(*motion.path, first, last, limits);
  const std::size_t begin = motion.timing.size();
  const auto replace_motion = [&](const Profile & profile) {
    motion.timing.resize(begin);
    motion.append(grid, profile, false);
  };
  replace_motion(
      solve_on_grid(grid, initial_timing(grid, limits), 4.0, limits, LimitFractions(grid), {0.1, 0.02}));
  for (int round = 0; round < 2; ++round) {
    if (auto finer = subdivide(motion, begin, grid, limits)) {
      grid = std::move(finer->first);
      replace_motion(solve_on_grid(grid, initial_timing_from(grid, std::move(finer->second)), 0.3, limits,
                                   LimitFractions(grid), {0.02}));
    }
  }
  LimitFractions limit_fractions(grid);
  for (int round = 0; round < 3; ++round) {
    if (!tighten_limits(motion, begin, limits, limit_fractions) && round > 0) {
      break;
    }
    replace_motion(solve_on_grid(grid, initial_timing_from(grid, profile_of(motion, begin)), 0.1, limits,
                                 limit_fractions, {0.004}));
  }
  slow_to_limits(motion, begin, limits);
}

void append_topp_ra(Motion & motion, std::size_t first, std::size_t last, const Limits & limits)
{
  const Grid coarse = coarse_grid(*motion.path, first, last);
  const Profile estimate = solve_topp_ra(coarse, limits);
  const double step = std::max(total_time(estimate.time) / max_stations, 0.005);
  const Grid grid =
      time_spaced_grid(*motion.path, coarse, estimate, std::min(step, total_time(estimate.time) / 50.0), 12);
  const std::size_t begin = motion.timing.size();
  motion.append(grid, solve_topp_ra(grid, limits), true);
  slow_to_limits(motion, begin, limits);
}

}  // namespace

void parameterize_segment(Motion & motion, std::size_t first, std::size_t last, const Limits & limits)
{
  if (motion.path->length() <= 0.0) {
    return;  // a path of a single point
  }
  const Limits inner = with_margin(limits);
  if (last - first == 1 && motion.path->pieces[first].is_line()) {
    append_s_curve_profile(motion, first, inner);
  } else if (limits.has_jerk()) {
    append_jerk_limited(motion, first, last, inner);
  } else {
    append_topp_ra(motion, first, last, inner);
  }
}

}  // namespace ur_ros_rtde::trajectory
