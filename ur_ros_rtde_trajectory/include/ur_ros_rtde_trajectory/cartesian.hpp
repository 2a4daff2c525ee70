#pragma once

#include <functional>
#include <stop_token>
#include <vector>

#include "ur_ros_rtde_trajectory/arm.hpp"
#include "ur_ros_rtde_trajectory/trajectory.hpp"

namespace ur_ros_rtde::kinematics {

struct CartesianOptions {
  double speed = 0.25;          ///< m/s of the TCP
  double rotation_speed = 1.0;  ///< rad/s of the TCP
  double blend_radius = 0.0;  ///< m that the TCP may stay from a pose to go round a corner; 0: it stops there
};

/// The joint positions near `guess` for a pose of the TCP, by someone who knows this very arm: its
/// controller.
using IkFunction = std::function<Expected<Joints>(const Pose & pose, const Joints & guess)>;

/// The fastest motion of the TCP along straight lines from `poses[0]`, where the arm is with `start`, through
/// the others, that keeps the limits of the joints and of the TCP.
///
/// `arm` has the published lengths, this arm is a little different. At the beginning and at up to 100 of the
/// poses, the last one among them, `reference` tells the joint positions; what the arm as published makes of
/// them is a correction that is carried over to the way between.
///
/// Refused (unreachable) with the pose and what is in the way: out of reach, a limit of a joint, a
/// singularity (a smallest singular value of the Jacobian, rotations by 0.2 m, below 0.01).
Expected<trajectory::Trajectory> plan_cartesian(const std::vector<Pose> & poses, const Arm & arm,
                                                const Joints & start, const trajectory::Limits & limits,
                                                const CartesianOptions & options, const IkFunction & ik,
                                                const std::stop_token & stop = {});

}  // namespace ur_ros_rtde::kinematics
