#include "solver/initial_timing.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "solver/speed_spline.hpp"
#include "solver/topp_ra.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

// Squared speeds of a motion with constant jerk from rest at both ends, a ~ s^(4/3), blended smoothly.
std::vector<double> jerk_limited_ramps(const Grid & grid, const Limits & limits)
{
  const auto factor = [&](const Joints & direction) {
    const double jerk = 0.7 * (limits.jerk / direction.abs().max(1e-300)).minCoeff();
    return 0.25 * std::cbrt(std::pow(6.0, 4) * jerk * jerk);
  };
  const std::size_t last = grid.stations() - 1;
  std::vector<double> from_begin(last + 1, 0.0);
  for (std::size_t m = 1; m <= last; ++m) {
    from_begin[m] = from_begin[m - 1] + grid.width(m - 1);
  }
  const double begin = factor(grid.d1.front());
  const double end = factor(grid.d1.back());
  std::vector<double> result(last + 1, 0.0);
  for (std::size_t m = 1; m < last; ++m) {
    const double up = begin * std::cbrt(std::pow(from_begin[m], 4));
    const double down = end * std::cbrt(std::pow(from_begin[last] - from_begin[m], 4));
    result[m] = 1.0 / (1.0 / up + 1.0 / down);
  }
  return result;
}

// Sliding minimum over the time window +-half_window around each station.
std::vector<double> sliding_min(const std::vector<double> & values, const std::vector<double> & time,
                                double half_window)
{
  std::vector<double> result(values.size());
  std::deque<std::size_t> window;  // indices of increasing values
  std::size_t next = 0;
  for (std::size_t m = 0; m < values.size(); ++m) {
    for (; next < values.size() && time[next] <= time[m] + half_window; ++next) {
      while (!window.empty() && values[window.back()] >= values[next]) {
        window.pop_back();
      }
      window.push_back(next);
    }
    while (time[window.front()] < time[m] - half_window) {
      window.pop_front();
    }
    result[m] = values[window.front()];
  }
  return result;
}

// Sliding mean over the time window +-half_window around each station. Values are extrapolated as constants
// beyond both ends.
std::vector<double> sliding_mean(const std::vector<double> & values, const std::vector<double> & time,
                                 double half_window)
{
  const std::size_t last = values.size() - 1;
  std::vector<double> sum(values.size(), 0.0);
  for (std::size_t m = 1; m <= last; ++m) {
    sum[m] = sum[m - 1] + 0.5 * (values[m] + values[m - 1]) * (time[m] - time[m - 1]);
  }
  std::size_t index = 0;
  const auto integral = [&](double t, std::size_t & i) {
    if (t <= time.front()) {
      return (t - time.front()) * values.front();
    }
    if (t >= time.back()) {
      return sum[last] + (t - time.back()) * values.back();
    }
    while (time[i + 1] < t) {
      ++i;
    }
    const double part = (t - time[i]) / (time[i + 1] - time[i]);
    return sum[i] + part * (time[i + 1] - time[i]) * (values[i] + 0.5 * part * (values[i + 1] - values[i]));
  };
  std::vector<double> result(values.size());
  std::size_t ahead = 0;
  for (std::size_t m = 0; m <= last; ++m) {
    const double low = integral(time[m] - half_window, index);
    result[m] = (integral(time[m] + half_window, ahead) - low) / (2.0 * half_window);
  }
  return result;
}

}  // namespace

InitialTiming initial_timing_from(const Grid & grid, Profile profile)
{
  const std::size_t count = grid.intervals();
  InitialTiming start{std::move(profile), std::vector<double>(count, 0.0), {}};
  const SpeedSpline spline(grid, start.profile);
  for (std::size_t m = 1; m < count; ++m) {
    // Each station contributes to both adjacent coefficients: a_m = (1 - l) w_(m-1) + l w_m, b_m = g (w_m -
    // w_(m-1)).
    const auto & at = spline.at(m);
    const double a = start.profile.v[m] * start.profile.v[m];
    const double rise = start.profile.alpha[m] / at.g;
    start.w[m - 1] += 0.5 * (a - at.l * rise);
    start.w[m] += 0.5 * (a + (1.0 - at.l) * rise);
  }
  start.w.front() = start.w.back() = 0.0;
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const double a = std::min(std::pow(start.profile.v[i], 2), std::pow(start.profile.v[i + 1], 2));
    start.w[i] = std::max(start.w[i], 0.3 * a);
  }
  return start;
}

namespace {

// Timing with the given squared speeds at the stations.
InitialTiming timing_from_squared_speeds(const Grid & grid, const std::vector<double> & squared_speeds)
{
  const std::size_t last = grid.stations() - 1;
  Profile profile;
  profile.v.assign(last + 1, 0.0);
  profile.alpha.assign(last + 1, 0.0);
  profile.time.assign(last, 0.0);
  for (std::size_t m = 1; m < last; ++m) {
    // Slope of the parabola through three stations.
    const double before = grid.width(m - 1);
    const double after = grid.width(m);
    const double left = (squared_speeds[m] - squared_speeds[m - 1]) / before;
    const double right = (squared_speeds[m + 1] - squared_speeds[m]) / after;
    profile.v[m] = std::sqrt(squared_speeds[m]);
    profile.alpha[m] = 0.5 * (left * after + right * before) / (before + after);
  }
  for (std::size_t i = 0; i < last; ++i) {
    profile.time[i] = interval_duration(grid.width(i), profile.v[i], profile.alpha[i], profile.v[i + 1],
                                        profile.alpha[i + 1]);
  }
  return initial_timing_from(grid, std::move(profile));
}

std::vector<double> cumulative_times(const std::vector<double> & times)
{
  std::vector<double> result(times.size() + 1, 0.0);
  for (std::size_t i = 0; i < times.size(); ++i) {
    result[i + 1] = result[i] + times[i];
  }
  return result;
}

}  // namespace

InitialTiming initial_timing(const Grid & grid, const Limits & limits, JerkSolver & solver)
{
  const Profile unlimited_jerk = solve_topp_ra(grid, limits);
  const std::vector<double> ramp = jerk_limited_ramps(grid, limits);
  const std::size_t last = grid.stations() - 1;
  std::vector<double> ramp_fraction(last + 1, 1.0);  // of the ramps
  for (std::size_t m = 1; m < last; ++m) {
    ramp_fraction[m] = std::min(1.0, unlimited_jerk.v[m] * unlimited_jerk.v[m] / ramp[m]);
  }
  const double half_window = (limits.acceleration / limits.jerk).maxCoeff();
  std::vector<double> time = cumulative_times(unlimited_jerk.time);
  ramp_fraction = sliding_mean(sliding_min(ramp_fraction, time, half_window), time, half_window);
  const LimitFractions limit_fractions(grid);
  solver.set_problem(grid, limit_fractions);
  std::vector<double> squared_speeds(last + 1, 0.0);
  for (int round = 0;; ++round) {
    for (std::size_t m = 1; m < last; ++m) {
      squared_speeds[m] = ramp[m] * ramp_fraction[m];
    }
    InitialTiming start = timing_from_squared_speeds(grid, squared_speeds);
    // Slow down locally where the limits are exceeded, with a smooth transition. The rest of the path keeps
    // its speed.
    std::vector<double> excess = solver.limit_ratios(SpeedSpline(grid, start.profile), start.w);
    if (round == 4 || *std::max_element(excess.begin(), excess.end()) < 1.5) {
      start.highest_speed = unlimited_jerk.v;
      return start;
    }
    excess.push_back(excess.back());
    for (double & value : excess) {
      value = 1.0 / std::max(1.0, value);
    }
    time = cumulative_times(start.profile.time);
    const auto slower = sliding_mean(sliding_min(excess, time, 0.5 * half_window), time, 0.5 * half_window);
    for (std::size_t m = 0; m <= last; ++m) {
      ramp_fraction[m] *= slower[m];
    }
  }
}

std::optional<Profile> lift_dips(const Grid & grid, const Profile & profile,
                                 const std::vector<double> & highest_speed)
{
  constexpr double dip = 0.15;       // of the highest speed
  constexpr double recovered = 0.5;  // of the highest speed
  const std::size_t last = grid.stations() - 1;
  Profile lifted = profile;
  bool found = false;
  for (std::size_t m = 2; m + 2 <= last; ++m) {
    const bool is_minimum = profile.v[m] <= profile.v[m - 1] && profile.v[m] < profile.v[m + 1];
    if (!is_minimum || profile.v[m] > dip * highest_speed[m]) {
      continue;
    }
    std::size_t left = m;
    std::size_t right = m;
    while (left > 0 && profile.v[left] < recovered * highest_speed[left]) {
      --left;
    }
    while (right < last && profile.v[right] < recovered * highest_speed[right]) {
      ++right;
    }
    if (left == 0 || right == last) {
      continue;
    }
    found = true;
    double length = 0.0;
    for (std::size_t i = left; i < right; ++i) {
      length += grid.width(i);
    }
    const double slope = (profile.v[right] - profile.v[left]) / length;
    for (std::size_t i = left; i < right; ++i) {
      lifted.v[i + 1] = lifted.v[i] + slope * grid.width(i);
      lifted.alpha[i + 1] = slope * lifted.v[i + 1];
      lifted.time[i] = 2.0 * grid.width(i) / (lifted.v[i] + lifted.v[i + 1]);
    }
    m = right;
  }
  return found ? std::optional(std::move(lifted)) : std::nullopt;
}

}  // namespace ur_ros_rtde::trajectory
