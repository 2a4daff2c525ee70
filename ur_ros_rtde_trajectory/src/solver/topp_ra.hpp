#pragma once

#include "motion/grid.hpp"

namespace ur_ros_rtde::trajectory {

/// Time-optimal path parameterization from rest to rest under velocity and acceleration limits, with constant
/// acceleration along the path in each interval. A backward pass computes the controllable squared speeds, a
/// forward pass selects the highest of them; the cost is linear in the number of stations. After H. Pham,
/// Q.-C. Pham: A New Approach to Time-Optimal Path Parameterization Based on Reachability Analysis, IEEE
/// Transactions on Robotics, 2018. Jerk limits only bound the speed where the path itself would exceed them
/// at constant speed.
Profile solve_topp_ra(const Grid & grid, const Limits & limits);

/// Maximum velocity curve: highest squared speed at a station according to the velocity limits and the
/// maximum speed of the path. Infinite if nothing limits it.
double max_squared_speed(const Grid & grid, std::size_t station, const Limits & limits);

}  // namespace ur_ros_rtde::trajectory
