#pragma once

#include <vector>

#include "motion/grid.hpp"

namespace ur_ros_rtde::trajectory {

/// Squared speed along the path, a(s) = (ds/dt)^2, as a spline. Its half derivative, the acceleration b =
/// a'/2, is piecewise linear *in the time of a given profile*. If that profile is the profile of the spline
/// itself, the jerk along the path is constant in each interval. This includes rest at both ends, where a ~
/// s^(4/3), which no polynomial in s can represent. There is one coefficient w_i per interval; at rest at the
/// start (end), the first (last) coefficient is zero.
///
///   a_m = (1 - l_m) w_(m-1) + l_m w_m     b_m = g_m (w_m - w_(m-1))     c_i = (b_(i+1) - b_i) / T_i
///
/// at station m and in interval i.
class SpeedSpline {
 public:
  /// Computes the weights for the time of `profile`.
  SpeedSpline(const Grid & grid, const Profile & profile);

  struct Weights {
    double l = 0.0;  ///< weight of w_m in a_m
    double g = 0.0;  ///< b_m = g (w_m - w_(m-1))
  };

  std::size_t intervals() const { return duration_.size(); }
  const Weights & at(std::size_t m) const { return weights_[m]; }
  double duration(std::size_t i) const { return duration_[i]; }
  /// Speed of the profile that determines the weights.
  double speed(std::size_t m) const { return speed_[m]; }

  double a(const std::vector<double> & w, std::size_t m) const
  {
    return inner(m) ? w[m - 1] + weights_[m].l * (w[m] - w[m - 1]) : 0.0;
  }
  double b(const std::vector<double> & w, std::size_t m) const
  {
    return inner(m) ? weights_[m].g * (w[m] - w[m - 1]) : 0.0;
  }

  /// Speed, acceleration and durations of the spline with coefficients `w`.
  Profile profile(const Grid & grid, const std::vector<double> & w) const;

 private:
  bool inner(std::size_t m) const { return m > 0 && m < duration_.size(); }

  std::vector<double> duration_, speed_;
  std::vector<Weights> weights_;
};

/// Duration of an interval of this width between two states, for a speed that is cubic in time.
double interval_duration(double width, double v0, double alpha0, double v1, double alpha1);

}  // namespace ur_ros_rtde::trajectory
