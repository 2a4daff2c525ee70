#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <vector>

#include "motion/grid.hpp"
#include "solver/constraint_block.hpp"
#include "solver/pentadiagonal.hpp"
#include "solver/search_limit.hpp"
#include "solver/speed_spline.hpp"

namespace ur_ros_rtde::trajectory {

/// Fractions of the limits that the solver may use. Below 1 where a previous solution exceeded the limits
/// between stations.
struct LimitFractions {
  std::vector<double> velocity;      ///< of each station
  std::vector<double> acceleration;  ///< of each station
  std::vector<double> jerk;          ///< of each interval
  /// Joints whose limits must not be left out in an interval: bit j for joint j.
  std::vector<std::uint8_t> binding_joints;

  LimitFractions() = default;
  explicit LimitFractions(const Grid & grid)
      : velocity(grid.stations(), 1.0),
        acceleration(grid.stations(), 1.0),
        jerk(grid.intervals(), 1.0),
        binding_joints(grid.intervals(), 0)
  {
  }
};

/// Time-optimal path parameterization from rest to rest under velocity, acceleration and jerk limits: a
/// feasible primal-dual interior-point method for the coefficients w of a SpeedSpline.
///
///   minimize    sum over stations of t_m sqrt(a^_m / a_m)    (the duration; ^: current profile)
///   subject to  a <= a_max,  |q'' a + q' b| <= A,  |q''' a + 3 q'' b + q' c / v^| <= J / sqrt(a)
///
/// J / sqrt(a) is convex. Its tangent at the current iterate is a lower bound, so every iterate keeps the
/// true limits at the stations. The cost of each step is linear in the number of stations. On a straight
/// line, the rows of all joints are proportional, so a single row replaces them.
class JerkSolver {
 public:
  explicit JerkSolver(const Limits & limits, SearchLimit search_limit = {});

  /// Sets the problem. `grid` and `limit_fractions` must outlive the solution; the fractions are read when a
  /// spline is set. `long_interval`: curved intervals of a longer duration (s, at the start) keep the
  /// acceleration limits in their middle, too. `near_solution`: the start is close to the solution, so the
  /// limits of joints that are far from binding are left out. The memory of the previous problem is reused.
  void set_problem(const Grid & grid, const LimitFractions & limit_fractions,
                   double long_interval = std::numeric_limits<double>::infinity(),
                   bool near_solution = false);
  /// Initializes with coefficients `w` of `spline`, scaled down until they keep the limits. `gap`: estimated
  /// distance from the optimum, as a fraction of the duration.
  void start(const SpeedSpline & spline, std::vector<double> w, double gap);
  /// Ratio of coefficients `w` to the limits at each station and in the following interval, as a factor on
  /// the squared speed. 1: at the limit.
  std::vector<double> limit_ratios(const SpeedSpline & spline, const std::vector<double> & w);
  /// Continues with another spline on the same grid. Keeps coefficients and multipliers.
  void set_spline(const SpeedSpline & spline);
  /// Runs up to `steps` iterations, until the estimated loss of time is below `gap`, a fraction of the
  /// duration, or the search has to end.
  void iterate(int steps, double gap);
  bool has_to_end() const { return search_limit_.is_reached(); }

  const std::vector<double> & coefficients() const { return w_; }
  double gap() const;
  double duration() const;

 private:
  // Multiplier of the maximum speed at a station.
  struct SpeedMultiplier {
    double value = 0.0, step = 0.0;
  };

  std::size_t count() const { return grid_->intervals(); }
  void add_blocks();
  void add_block(const ConstraintBlock<joint_count> & block);
  template <int rows>
  void add_rows(const ConstraintBlock<joint_count> & block,
                const std::array<std::uint8_t, joint_count> & joints);
  Joints closeness(const ConstraintBlock<joint_count> & block) const;
  unsigned required_joints(const ConstraintBlock<joint_count> & block) const;
  template <int rows>
  void set_middle(ConstraintBlock<rows> & block) const;
  template <class Function>
  void for_each_block(const Function & function);
  template <class Function>
  void for_each_block(const Function & function) const;

  void set_states();
  void evaluate();
  template <int rows>
  void evaluate(ConstraintBlock<rows> & block) const;
  double limit_ratio() const;
  void scale_to_limits(double target);
  double mean_complementarity() const;

  void assemble(double target);
  void add_time_and_speed(std::size_t m, double target);
  void scatter_model(std::size_t i, std::size_t m, const QuadraticModel & model);
  StepLengths step_lengths(const std::vector<double> & dw, double target);
  void step_speed(std::size_t m, double da, double target, StepLengths & lengths);
  double advance(const std::vector<double> & dw, const StepLengths & lengths);

  Limits limits_;
  SearchLimit search_limit_;
  Joints inverse_acceleration_, inverse_jerk_;
  const Grid * grid_ = nullptr;
  const LimitFractions * limit_fractions_ = nullptr;
  const SpeedSpline * spline_ = nullptr;
  double long_interval_ = 0.0;
  bool near_solution_ = false;
  double rows_ = 0.0;
  std::vector<double> max_a_;   // highest a at each station
  std::vector<double> weight_;  // t_m
  std::vector<double> w_, a_, b_, c_, da_, db_, dc_;
  // Limits of one, two, four and six joints, each in the order of the intervals.
  std::tuple<std::vector<ConstraintBlock<1>>, std::vector<ConstraintBlock<2>>,
             std::vector<ConstraintBlock<4>>, std::vector<ConstraintBlock<6>>>
      blocks_;
  std::vector<SpeedMultiplier> speed_;
  std::vector<QuadraticModel> begin_models_, end_models_;  // of each interval, in a and b of its ends
  Pentadiagonal system_;
};

template <class Function>
void JerkSolver::for_each_block(const Function & function)
{
  const auto visit = [&](auto & blocks) {
    for (auto & block : blocks) {
      function(block);
    }
  };
  std::apply([&](auto &... blocks) { (visit(blocks), ...); }, blocks_);
}

template <class Function>
void JerkSolver::for_each_block(const Function & function) const
{
  const auto visit = [&](const auto & blocks) {
    for (const auto & block : blocks) {
      function(block);
    }
  };
  std::apply([&](const auto &... blocks) { (visit(blocks), ...); }, blocks_);
}

template <int rows>
void JerkSolver::evaluate(ConstraintBlock<rows> & block) const
{
  const double a = a_[block.station];
  if (block.is_jerk()) {
    block.sa = std::sqrt(a);
    block.sc = block.sa / spline_->speed(block.station);
    block.tangent = 0.5 * block.limit / a;
  }
  block.evaluate(a, b_[block.station], c_[block.interval]);
}

}  // namespace ur_ros_rtde::trajectory
