#include "timing/resampling.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace ur_ros_rtde::trajectory {
namespace {

void append_station(ResampledMotion & result, const PathState & state, double time)
{
  result.profile.v.push_back(state.v);
  result.profile.alpha.push_back(state.a);
  result.profile.time.push_back(time);
}

// Adds stations for the pieces of the timing law that lie on one piece of the path.
void resample_piece(const Path & path, std::span<const TimingLawPiece> timing,
                    std::span<const double> spacing, std::size_t min_intervals, ResampledMotion & result)
{
  double total = 0.0;  // intervals
  for (std::size_t i = 0; i < timing.size(); ++i) {
    total += timing[i].duration / spacing[i];
  }
  const std::size_t count = std::max(min_intervals, static_cast<std::size_t>(std::ceil(total)));
  const std::size_t piece = timing.front().piece;
  const double length = path.pieces[piece].length;
  const double min_width = 1e-6 * length;  // minimum distance of stations, independent of the times
  double from = 0.0;
  double from_time = timing.front().start;
  double passed = 0.0;  // intervals until the start of timing[i]
  std::size_t i = 0;
  for (std::size_t k = 1; k < count; ++k) {
    const double target = total * static_cast<double>(k) / static_cast<double>(count);
    while (i + 1 < timing.size() && passed + timing[i].duration / spacing[i] < target) {
      passed += timing[i].duration / spacing[i];
      ++i;
    }
    const double time = timing[i].start + std::min((target - passed) * spacing[i], timing[i].duration);
    const PathState state = timing[i].at(time);
    if (state.u - from > min_width && length - state.u > min_width) {
      result.grid.add(path, piece, from, state.u);
      append_station(result, state, time - from_time);
      from = state.u;
      from_time = time;
    }
  }
  result.grid.add(path, piece, from, length);
  append_station(result, timing.back().at(timing.back().end()), timing.back().end() - from_time);
}

}  // namespace

ResampledMotion resample(const Motion & motion, std::size_t begin, const std::vector<double> & spacing,
                         std::size_t min_blend_intervals)
{
  const std::span timing(motion.timing.data() + begin, motion.timing.size() - begin);
  ResampledMotion result;
  result.profile.v.push_back(0.0);
  result.profile.alpha.push_back(0.0);
  std::size_t first = 0;
  while (first < timing.size()) {
    std::size_t last = first;
    while (last < timing.size() && timing[last].piece == timing[first].piece) {
      ++last;
    }
    const bool is_blend = motion.path->pieces[timing[first].piece].degree > 3;
    resample_piece(*motion.path, timing.subspan(first, last - first),
                   std::span(spacing).subspan(first, last - first), is_blend ? min_blend_intervals : 1,
                   result);
    first = last;
  }
  result.profile.v.back() = result.profile.alpha.back() = 0.0;
  return result;
}

std::vector<double> adaptive_spacing(const Grid & grid, const Profile & profile, const Limits & limits,
                                     double step, double max_stations)
{
  constexpr double max_factor = 12.0;  // longest spacing, in steps
  constexpr double growth = 0.5;       // increase of the spacing per elapsed time
  const std::size_t count = grid.intervals();
  std::vector<double> spacing(count, max_factor * step);
  // `jump`: the jump of the jerk along the path at station m, as a fraction of the jerk limit.
  const auto add_jump = [&](std::size_t m, double jump) {
    const double allowed = step / std::sqrt(std::clamp(jump, 1.0 / (max_factor * max_factor), 1.0));
    spacing[std::max<std::size_t>(m, 1) - 1] = std::min(spacing[std::max<std::size_t>(m, 1) - 1], allowed);
    spacing[std::min(m, count - 1)] = std::min(spacing[std::min(m, count - 1)], allowed);
  };
  const auto path_jerk = [&](std::size_t i) {
    return (profile.alpha[i + 1] - profile.alpha[i]) / profile.time[i];
  };
  add_jump(0, 1.0);
  add_jump(count, 1.0);
  for (std::size_t m = 1; m < count; ++m) {
    const double limit = (limits.jerk / grid.d1[m].abs().max(1e-300)).minCoeff();
    add_jump(m, std::abs(path_jerk(m) - path_jerk(m - 1)) / limit);
  }
  // Neighboring intervals have similar spacings.
  const auto grown = [&](std::size_t i, std::size_t neighbor) {
    return spacing[neighbor] + growth * 0.5 * (profile.time[i] + profile.time[neighbor]);
  };
  for (std::size_t i = 1; i < count; ++i) {
    spacing[i] = std::min(spacing[i], grown(i, i - 1));
  }
  for (std::size_t i = count - 1; i-- > 0;) {
    spacing[i] = std::min(spacing[i], grown(i, i + 1));
  }
  double stations = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    stations += profile.time[i] / spacing[i];
  }
  for (double & value : spacing) {
    value *= std::max(1.0, stations / max_stations);
  }
  return spacing;
}

}  // namespace ur_ros_rtde::trajectory
