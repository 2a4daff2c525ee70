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

}  // namespace ur_ros_rtde::trajectory
