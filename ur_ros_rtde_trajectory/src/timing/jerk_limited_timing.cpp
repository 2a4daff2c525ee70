#include "timing/jerk_limited_timing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numeric>

#include "solver/initial_timing.hpp"
#include "solver/topp_ra.hpp"
#include "timing/limit_refinement.hpp"
#include "timing/resampling.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

constexpr double min_station_step = 0.002;      // s, between stations
constexpr std::size_t min_blend_intervals = 6;  // intervals in a blend
constexpr double max_rough_stations = 20000.0;
constexpr double max_adaptive_stations = 30000.0;
constexpr double max_rough_factor = 8.0;  // longest step of the rough grid, in fine steps
constexpr double min_rough_stations = 300.0;
constexpr double min_stations_per_piece = 12.0;  // with fewer, an adaptive grid has no advantage

// Accepted slowdown of the motion instead of another solution, by the number of previous refinements.
constexpr std::array accepted_slowdown{0.0, 1e-3, 2e-3, 3e-3, 5e-3, 0.01, 0.01, 0.01};
constexpr std::size_t max_rounds = accepted_slowdown.size();

// Timing of one segment of the path. The pieces of the timing law from `begin` on belong to it, one for each
// interval of the grid.
class JerkLimitedTiming {
 public:
  JerkLimitedTiming(Motion & motion, std::size_t first, std::size_t last, const Limits & limits,
                    JerkSolver & solver)
      : motion_(motion), begin_(motion.timing.size()), limits_(limits), solver_(solver)
  {
    coarse_grid_ = coarse_grid(*motion.path, first, last);
    estimate_ = solve_topp_ra(coarse_grid_, limits);
    duration_ = std::accumulate(estimate_.time.begin(), estimate_.time.end(), 0.0);
    const double jerk_time = (limits.acceleration / limits.jerk).minCoeff();
    step_ = std::min(std::max(0.3 * jerk_time, min_station_step), duration_ / 100.0);
    rough_step_ = std::clamp(duration_ / min_rough_stations, step_, max_rough_factor * step_);
    has_long_pieces_ = duration_ > min_stations_per_piece * step_ * static_cast<double>(last - first);
  }

  bool can_adapt_grid() const { return has_long_pieces_ && rough_step_ > step_; }

  // Solves on a rough grid, then on a grid that is fine only where the jerk changes. Returns false if the
  // result exceeds a limit significantly.
  bool solve_with_adaptive_grid()
  {
    set_uniform_grid(std::max(rough_step_, duration_ / max_rough_stations));
    const Profile rough = solve_from_scratch({0.1});
    ResampledMotion fine =
        resample(motion_, begin_, adaptive_spacing(grid_, rough, limits_, step_, max_adaptive_stations),
                 min_blend_intervals);
    set_grid(std::move(fine.grid));
    long_interval_ = 1.05 * step_;
    solve(initial_timing_from(grid_, std::move(fine.profile)), 1.0, {0.1, 0.02}, true);
    return refine() < 1.01;
  }

  void solve_with_uniform_grid()
  {
    long_interval_ = std::numeric_limits<double>::infinity();
    set_uniform_grid(std::max(step_, duration_ / max_stations));
    solve_from_scratch({0.1, 0.02});
    refine();
  }

 private:
  void set_grid(Grid grid)
  {
    grid_ = std::move(grid);
    fractions_ = LimitFractions(grid_);
  }

  void set_uniform_grid(double step)
  {
    set_grid(time_spaced_grid(*motion_.path, coarse_grid_, estimate_, step, min_blend_intervals));
  }

  Profile solve_from_scratch(std::initializer_list<double> gaps)
  {
    const InitialTiming start = initial_timing(grid_, limits_, solver_);
    Profile profile = solve(start, 4.0, gaps);
    if (!motion_.is_finite(begin_)) {
      replace_motion(start.profile);
      return start.profile;
    }
    if (auto lifted = lift_dips(grid_, profile, start.highest_speed)) {
      const double before = motion_.duration();
      Profile other = solve(initial_timing_from(grid_, std::move(*lifted)), 4.0, gaps);
      if (motion_.is_finite(begin_) && motion_.duration() < before) {
        return other;
      }
      replace_motion(profile);
    }
    return profile;
  }

  void replace_motion(const Profile & profile)
  {
    motion_.timing.resize(begin_);
    motion_.append(grid_, profile, false);
  }

  // Solves on the grid. The solution replaces that in `motion`. `gaps`: optimality gaps of the successive
  // speed splines. `near_solution`: the start is close to the solution.
  Profile solve(InitialTiming start, double initial_gap, std::initializer_list<double> gaps,
                bool near_solution = false)
  {
    SpeedSpline spline(grid_, start.profile);
    solver_.set_problem(grid_, fractions_, long_interval_, near_solution);
    solver_.start(spline, std::move(start.w), initial_gap);
    Profile profile;
    for (const double gap : gaps) {
      if (!profile.v.empty()) {
        spline = SpeedSpline(grid_, profile);
        solver_.set_spline(spline);
      }
      solver_.iterate(profile.v.empty() ? 40 : 20, gap);
      profile = spline.profile(grid_, solver_.coefficients());
    }
    replace_motion(profile);
    return profile;
  }

  // Subdivides intervals and tightens limits where the solution exceeds the limits between stations, and
  // solves again with higher accuracy. If that diverges, keeps the last finite solution. Returns the factor
  // by which the motion still has to be slowed down.
  double refine()
  {
    std::vector<TimingLawPiece> last_finite;
    double slowdown = std::numeric_limits<double>::infinity();
    for (std::size_t round = 0;; ++round) {
      if (!motion_.is_finite(begin_)) {
        if (round > 0) {
          motion_.timing.resize(begin_);
          motion_.timing.insert(motion_.timing.end(), last_finite.begin(), last_finite.end());
        }
        return slowdown;
      }
      const std::vector<IntervalUtilization> use = interval_utilization(motion_, begin_, limits_);
      slowdown = 1.0;
      bool any_too_long = false;
      for (const IntervalUtilization & interval : use) {
        slowdown = std::max(slowdown, interval.slowdown());
        any_too_long = any_too_long || interval.too_long;
      }
      const bool accepted = round > 0 && slowdown <= 1.0 + accepted_slowdown[std::min(round, max_rounds - 1)];
      if (accepted || round == max_rounds || !std::isfinite(slowdown) || solver_.has_to_end()) {
        return slowdown;
      }
      last_finite.assign(motion_.timing.begin() + static_cast<std::ptrdiff_t>(begin_), motion_.timing.end());
      tighten_limits(use, fractions_);
      Profile start;
      if (any_too_long) {
        ResampledMotion fine = subdivide(motion_, begin_, grid_, use, fractions_);
        grid_ = std::move(fine.grid);
        start = std::move(fine.profile);
      } else {
        start = profile_of_motion();
      }
      solve(initial_timing_from(grid_, std::move(start)), 0.1, {0.004}, true);
    }
  }

  // State of the motion at the stations.
  Profile profile_of_motion() const
  {
    Profile profile;
    for (std::size_t k = begin_; k < motion_.timing.size(); ++k) {
      const PathState state = motion_.timing[k].at(motion_.timing[k].start);
      profile.v.push_back(state.v);
      profile.alpha.push_back(state.a);
      profile.time.push_back(motion_.timing[k].duration);
    }
    profile.v.push_back(0.0);
    profile.alpha.push_back(0.0);
    return profile;
  }

  Motion & motion_;
  std::size_t begin_;
  const Limits & limits_;
  JerkSolver & solver_;
  Grid coarse_grid_;
  Profile estimate_;              // on the coarse grid, without jerk limits
  double duration_ = 0.0;         // s, of the estimate
  double step_ = 0.0;             // s, between stations where the jerk changes
  double rough_step_ = 0.0;       // s, between the stations of the rough grid
  bool has_long_pieces_ = false;  // pieces that are long compared with the step
  double long_interval_ = std::numeric_limits<double>::infinity();  // s
  Grid grid_;
  LimitFractions fractions_;
};

}  // namespace

Grid coarse_grid(const Path & path, std::size_t first, std::size_t last)
{
  return uniform_grid(path, first, last, std::clamp<std::size_t>(1500 / (last - first), 4, 12));
}

void append_jerk_limited(Motion & motion, std::size_t first, std::size_t last, const Limits & limits,
                         JerkSolver & solver)
{
  const std::size_t begin = motion.timing.size();
  JerkLimitedTiming timing(motion, first, last, limits, solver);
  if (timing.can_adapt_grid() && timing.solve_with_adaptive_grid()) {
    return;
  }
  const bool found = motion.timing.size() > begin && motion.is_finite(begin);
  if (!found || !solver.has_to_end()) {
    timing.solve_with_uniform_grid();
  }
}

}  // namespace ur_ros_rtde::trajectory
