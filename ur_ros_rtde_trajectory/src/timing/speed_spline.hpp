#pragma once

#include <vector>

#include "timing/grid.hpp"

namespace ur_ros_rtde::trajectory {

/// The square of the speed along the path, a(s) = (ds/dt)^2, as a spline whose half derivative, the
/// acceleration b = a'/2, is piecewise linear *in the time of a given profile*. Where that profile is the
/// spline's own, the jerk along the path is constant in each interval, rest at both ends included (where a ~
/// s^(4/3) and no polynomial in s would do). One coefficient w_i per interval; a rest at the beginning (end)
/// makes the first (last) one zero.
///
///   a_m = (1 - l_m) w_(m-1) + l_m w_m     b_m = g_m (w_m - w_(m-1))     c_i = (b_(i+1) - b_i) / T_i
///
/// at station m and in interval i.
class SpeedSpline {
 public:
  /// Weights for the time of `profile`.
  SpeedSpline(const Grid & grid, const Profile & profile);

  struct Weights {
    double l = 0.0;  ///< weight of w_m in a_m
    double g = 0.0;  ///< b_m = g (w_m - w_(m-1))
  };

  std::size_t intervals() const { return duration_.size(); }
  const Weights & at(std::size_t m) const { return weights_[m]; }
  double duration(std::size_t i) const { return duration_[i]; }
  /// Speed of the underlying profile.
  double speed(std::size_t m) const { return speed_[m]; }

  double a(const std::vector<double> & w, std::size_t m) const
  {
    return inner(m) ? w[m - 1] + weights_[m].l * (w[m] - w[m - 1]) : 0.0;
  }
  double b(const std::vector<double> & w, std::size_t m) const
  {
    return inner(m) ? weights_[m].g * (w[m] - w[m - 1]) : 0.0;
  }

  /// Speed and acceleration of the spline with coefficients `w`, and the times they take.
  Profile profile(const Grid & grid, const std::vector<double> & w) const;

 private:
  bool inner(std::size_t m) const { return m > 0 && m < duration_.size(); }

  std::vector<double> duration_, speed_;
  std::vector<Weights> weights_;
};

/// The time of an interval of this width between two states, when the speed is a cubic in time.
double interval_duration(double width, double v0, double alpha0, double v1, double alpha1);

}  // namespace ur_ros_rtde::trajectory
