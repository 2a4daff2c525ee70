#pragma once

#include <trajectory_msgs/msg/joint_trajectory.hpp>

#include "streaming/execute.hpp"
#include "ur_ros_rtde/check.hpp"

namespace ur_ros_rtde {

/// Checks a trajectory with given times against `limits`. If its first point has time 0, the arm also has to
/// be there within `start_tolerance` (rad). The names of the joints have the prefix of this arm or none.
void check_timed_trajectory(Check & check, const trajectory_msgs::msg::JointTrajectory & message,
                            const trajectory::Limits & limits, double start_tolerance,
                            const std::string & prefix);

/// Plans a spline from `start` through the points of the trajectory at their times.
Expected<trajectory::Trajectory> plan_timed_trajectory(const trajectory_msgs::msg::JointTrajectory & message,
                                                       const trajectory::Joints & start,
                                                       const trajectory::Limits & limits);

}  // namespace ur_ros_rtde
