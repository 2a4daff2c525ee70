#pragma once

#include <vector>

#include "timing/grid.hpp"
#include "timing/pentadiagonal.hpp"
#include "timing/speed_spline.hpp"

namespace ur_ros_rtde::trajectory {

/// Fractions of the limits that the solver may use. Below 1 where a previous solution exceeded the limits
/// between stations.
struct LimitFractions {
  std::vector<double> acceleration;  ///< of each station
  std::vector<double> jerk;          ///< of each interval

  explicit LimitFractions(const Grid & grid) : acceleration(grid.stations(), 1.0), jerk(grid.intervals(), 1.0)
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
/// true limits and is an executable timing. The cost of each step is linear in the number of stations.
class JerkSolver {
 public:
  JerkSolver(const Grid & grid, const Limits & limits, const LimitFractions & limit_fractions);

  /// Initializes with coefficients `w` of `spline`, scaled down until they keep the limits. `gap`: estimated
  /// distance from the optimum, as a fraction of the duration.
  void start(const SpeedSpline & spline, std::vector<double> w, double gap);
  /// Ratio of coefficients `w` to the limits at each station and in the following interval, as a factor on
  /// the squared speed. 1: at the limit.
  std::vector<double> limit_ratios(const SpeedSpline & spline, const std::vector<double> & w);
  /// Continues with another spline on the same grid. Keeps coefficients and multipliers.
  void set_spline(const SpeedSpline & spline);
  /// Runs up to `steps` iterations, until the estimated loss of time is below `gap`, a fraction of the
  /// duration.
  void iterate(int steps, double gap);

  const std::vector<double> & coefficients() const { return w_; }
  double gap() const;
  double duration() const;

 private:
  // Multipliers of the constraints of interval i and of the station where it starts. Plus and minus: upper
  // and lower limit.
  struct Multipliers {
    Joints station_plus, station_minus, begin_plus, begin_minus, end_plus, end_minus;
    double speed = 0.0;
  };
  // Jerk constraint at one end of an interval: |pa a + pb b + pc c| <= f, with a and b of station `at`.
  struct JerkRow {
    std::size_t at = 0;
    Joints pa, pb, pc;
    double tangent = 0.0;  // f / (2 a), slope of the linearized right-hand side
    Joints value;
  };
  // Quadratic model in a and b of a station and c of an interval.
  struct Model {
    double aa = 0, ab = 0, ac = 0, bb = 0, bc = 0, cc = 0, ga = 0, gb = 0, gc = 0;
  };
  struct StepLengths {
    double primal = 1.0, dual = 1.0;
  };

  std::size_t count() const { return grid_.intervals(); }
  void evaluate();
  double limit_ratio(std::size_t m) const;
  void scale_to_limits(double target);
  JerkRow jerk_row(std::size_t i, bool end) const;
  double mean_complementarity() const;
  void center_multipliers(double mu, double spread);

  void assemble(double target);
  void add_station(std::size_t m, double target);
  void add_interval(std::size_t i, double target);
  static Model jerk_model(const JerkRow & row, double f, const Joints & plus, const Joints & minus,
                          double target);
  void scatter_model(std::size_t i, std::size_t m, const Model & model);

  StepLengths step_lengths(const std::vector<double> & dw, double target);
  void station_step_lengths(std::size_t m, double da, double db, double target, StepLengths & steps);
  static void update_multipliers(const Joints & room, const Joints & used, const Joints & multiplier,
                                 double target, Joints & change, StepLengths & steps);
  void advance(const std::vector<double> & dw, const StepLengths & steps);

  const Grid & grid_;
  const LimitFractions & limit_fractions_;
  const SpeedSpline * spline_ = nullptr;
  Joints inverse_acceleration_, inverse_jerk_;
  std::vector<double> max_a_;   // highest a at each station
  std::vector<double> weight_;  // t_m
  std::vector<double> w_, a_, b_, c_;
  std::vector<Joints> acceleration_use_;  // utilization of the acceleration limits at each station
  std::vector<JerkRow> begin_jerk_, end_jerk_;
  std::vector<Multipliers> multipliers_, multiplier_step_;
  Pentadiagonal system_;
};

}  // namespace ur_ros_rtde::trajectory
