#pragma once

#include <span>
#include <vector>

#include "ur_ros_rtde_trajectory/limits.hpp"

namespace ur_ros_rtde::trajectory {

/// First derivatives at the knots of the cubic spline through `values` whose second derivative is continuous,
/// and zero at both ends. `widths` are the distances between neighbouring knots, one fewer than the values.
std::vector<Joints> natural_spline_slopes(std::span<const Joints> values, std::span<const double> widths);

/// As above, with the first derivatives at both ends given.
std::vector<Joints> clamped_spline_slopes(std::span<const Joints> values, std::span<const double> widths,
                                          const Joints & first, const Joints & last);

}  // namespace ur_ros_rtde::trajectory
