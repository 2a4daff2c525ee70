#pragma once

#include <span>
#include <vector>

#include "ur_ros_rtde_trajectory/limits.hpp"

namespace ur_ros_rtde::trajectory {

/// First derivatives at the knots of the natural cubic spline through `values`: its second derivative is
/// continuous, and zero at both ends. `widths`: distances between adjacent knots, one fewer than values.
std::vector<Joints> natural_spline_slopes(std::span<const Joints> values, std::span<const double> widths);

/// First derivatives at the knots of the cubic spline with the given first derivatives at both ends.
std::vector<Joints> clamped_spline_slopes(std::span<const Joints> values, std::span<const double> widths,
                                          const Joints & first, const Joints & last);

/// Limits first derivatives at the knots, so that an interpolation stays between the values of adjacent knots
/// (F. N. Fritsch and R. E. Carlson: Monotone Piecewise Cubic Interpolation, SIAM Journal on Numerical
/// Analysis 17, 1980): 0 at knots from which the values go back or stay, less where the slope is much steeper
/// than the line to a neighbor. Intervals up to `dense` wide between neighbors up to `dense` wide do not
/// count.
void limit_slopes(std::vector<Joints> & slopes, std::span<const Joints> values,
                  std::span<const double> widths, double dense);

}  // namespace ur_ros_rtde::trajectory
