#include "timing/segment_timing.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "motion/verify.hpp"
#include "solver/topp_ra.hpp"
#include "timing/jerk_limited_timing.hpp"
#include "timing/s_curve_profile.hpp"

namespace ur_ros_rtde::trajectory {

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

void append_topp_ra(Motion & motion, std::size_t first, std::size_t last, const Limits & limits)
{
  const Grid coarse = coarse_grid(*motion.path, first, last);
  const Profile estimate = solve_topp_ra(coarse, limits);
  const double total = std::accumulate(estimate.time.begin(), estimate.time.end(), 0.0);
  const double step = std::min(std::max(total / max_stations, 0.005), total / 50.0);
  const Grid grid = time_spaced_grid(*motion.path, coarse, estimate, step, 12);
  const std::size_t begin = motion.timing.size();
  motion.append(grid, solve_topp_ra(grid, limits), true);
  slow_to_limits(motion, begin, limits);
}

}  // namespace

void parameterize_segment(Motion & motion, std::size_t first, std::size_t last, const Limits & limits,
                          JerkSolver & solver)
{
  if (motion.path->length() <= 0.0) {
    return;  // a path of a single point
  }
  if (last - first == 1 && motion.path->pieces[first].is_line()) {
    append_s_curve_profile(motion, first, limits);
  } else if (limits.has_jerk()) {
    const std::size_t begin = motion.timing.size();
    append_jerk_limited(motion, first, last, limits, solver);
    slow_to_limits(motion, begin, limits);
  } else {
    append_topp_ra(motion, first, last, limits);
  }
}

}  // namespace ur_ros_rtde::trajectory
