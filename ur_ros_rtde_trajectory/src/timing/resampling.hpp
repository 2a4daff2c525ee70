#pragma once

#include "motion/motion.hpp"

namespace ur_ros_rtde::trajectory {

/// Grid with the state of a motion at each of its stations.
struct ResampledMotion {
  Grid grid;
  Profile profile;
};

/// Places stations along the pieces of the timing law of `motion` from `begin` on, which belong to one
/// segment of the path. `spacing`: time between two stations, for each of these pieces. A blend has at least
/// `min_blend_intervals` intervals.
ResampledMotion resample(const Motion & motion, std::size_t begin, const std::vector<double> & spacing,
                         std::size_t min_blend_intervals);

/// Time between two stations for each interval of `grid`, whose solution is `profile`: `step` where the jerk
/// along the path jumps, longer where it is nearly constant, because there few stations represent the motion
/// exactly. At most about `max_stations` in total.
std::vector<double> adaptive_spacing(const Grid & grid, const Profile & profile, const Limits & limits,
                                     double step, double max_stations);

}  // namespace ur_ros_rtde::trajectory
