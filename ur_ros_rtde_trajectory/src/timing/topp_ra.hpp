#pragma once

#include "timing/grid.hpp"

namespace ur_ros_rtde::trajectory {

/// Time-optimal timing from rest to rest under velocity and acceleration limits: the acceleration along the
/// path is constant in each interval. One pass backward (which speeds still let the motion stop), one forward
/// (as fast as these allow); linear in the number of stations. After H. Pham, Q.-C. Pham: A New Approach to
/// Time-Optimal Path Parameterization Based on Reachability Analysis, IEEE Transactions on Robotics, 2018.
/// Jerk limits only bound the speed where the path itself, passed at constant speed, would exceed them.
Profile solve_topp_ra(const Grid & grid, const Limits & limits);

/// Highest square of the speed that velocity limits, and the path itself, allow at a station; infinite where
/// nothing limits it.
double max_squared_speed(const Grid & grid, std::size_t station, const Limits & limits);

}  // namespace ur_ros_rtde::trajectory
