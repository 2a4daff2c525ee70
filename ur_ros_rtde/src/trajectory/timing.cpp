#include "trajectory/timing.hpp"

#include <algorithm>
#include <cmath>

#include "trajectory/jerk_solver.hpp"
#include "trajectory/reach.hpp"
#include "trajectory/straight.hpp"
#include "trajectory/verify.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

constexpr int inner_points = 3;  // looked at between two stations
constexpr double most_stations = 100000;

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

// Slows down everything from piece `begin` on until no limit is exceeded.
void slow_to_limits(Motion & motion, std::size_t begin, const Limits & limits)
{
  constexpr double margin = 2e-4;  // for what happens between the points looked at
  for (int round = 0; round < 6; ++round) {
    const Utilisation use = largest_use(motion, begin, limits);
    const double factor = std::max({use.velocity, std::sqrt(use.acceleration), std::cbrt(use.jerk)});
    if (factor <= 1.0 - 0.5 * margin) {
      return;
    }
    motion.stretch(factor * (1.0 + margin), begin);
  }
}

// The first guess of a(s) with rest at both ends approached as constant jerk does: a ~ s^(4/3).
std::vector<double> first_squares(const Grid & grid, const Limits & limits)
{
  const Profile guess = fastest_without_jerk(grid, limits);
  const auto ramp = [&](const Joints & direction) {
    const double jerk = 0.5 * (limits.jerk / direction.abs().max(1e-300)).minCoeff();
    return 0.25 * std::cbrt(std::pow(6.0, 4) * jerk * jerk);
  };
  const double begin = ramp(grid.d1.front());
  const double end = ramp(grid.d1.back());
  std::vector<double> squares(grid.stations(), 0.0);
  double distance = 0.0;
  for (std::size_t m = 1; m < squares.size(); ++m) {
    distance += grid.width(m - 1);
    squares[m] = std::min(guess.v[m] * guess.v[m], begin * std::cbrt(std::pow(distance, 4)));
  }
  distance = 0.0;
  for (std::size_t m = squares.size() - 1; m-- > 0;) {
    distance += grid.width(m);
    squares[m] = std::min(squares[m], end * std::cbrt(std::pow(distance, 4)));
  }
  return squares;
}

struct Start {
  Profile profile;
  std::vector<double> w;
};

Start first_guess(const Grid & grid, const Limits & limits)
{
  const std::vector<double> squares = first_squares(grid, limits);
  const std::size_t count = grid.intervals();
  Start start;
  start.w.assign(count, 0.0);
  for (std::size_t i = 1; i + 1 < count; ++i) {
    start.w[i] = 0.5 * (squares[i] + squares[i + 1]);
  }
  start.profile.v.assign(count + 1, 0.0);
  start.profile.alpha.assign(count + 1, 0.0);
  start.profile.time.assign(count, 0.0);
  for (std::size_t m = 1; m < count; ++m) {
    start.profile.v[m] = std::sqrt(squares[m]);
    start.profile.alpha[m] = (start.w[m] - start.w[m - 1]) / (grid.width(m - 1) + grid.width(m));
  }
  for (std::size_t i = 0; i < count; ++i) {
    start.profile.time[i] = interval_time(grid.width(i), start.profile.v[i], start.profile.alpha[i],
                                          start.profile.v[i + 1], start.profile.alpha[i + 1]);
  }
  for (int round = 0; round < 2; ++round) {
    start.profile = SpeedSpline(grid, start.profile).profile(grid, start.w);
  }
  return start;
}

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
  const double jerk_time = (limits.acceleration / limits.jerk).maxCoeff();
  const double step = std::clamp(0.3 * jerk_time, total / most_stations, total / 40.0);
  return timed_grid(path, coarse, guess, step, 6);
}

void append_jerk_limited(Motion & motion, std::size_t first, std::size_t last, const Limits & limits)
{
  const Grid grid = grid_for_jerk(*motion.path, first, last, limits);
  Allowance allowance(grid);
  Start guess = first_guess(grid, limits);
  SpeedSpline spline(grid, guess.profile);
  JerkSolver solver(grid, limits, allowance);
  solver.start(spline, std::move(guess.w));
  const std::size_t begin = motion.timing.size();
  const double gaps[] = {0.05, 0.01, 0.002, 0.002, 0.002};
  for (int round = 0; round < 5; ++round) {
    solver.improve(12, gaps[round]);
    const Profile profile = spline.profile(grid, solver.coefficients());
    motion.timing.resize(begin);
    motion.append(grid, profile, false);
    if (round >= 2 && !tighten(motion, begin, limits, allowance)) {
      break;
    }
    spline = SpeedSpline(grid, profile);
    solver.change_spline(spline);
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
  if (last - first == 1 && motion.path->pieces[first].straight()) {
    append_straight_motion(motion, first, limits);
  } else if (limits.has_jerk()) {
    append_jerk_limited(motion, first, last, limits);
  } else {
    append_fastest(motion, first, last, limits);
  }
}

}  // namespace ur_ros_rtde::trajectory
