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
  double blend_radius =
      0.0;  ///< m; largest distance from a pose when a corner is blended. 0: stop at each corner
};

/// Inverse kinematics of the real arm, solved by its controller: joint positions near `guess` for a pose of
/// the TCP.
using IkFunction = std::function<Expected<Joints>(const Pose & pose, const Joints & guess)>;

/// Plans the time-optimal motion of the TCP along straight lines from `poses[0]`, where the arm is at
/// `start`, through all other poses, within the limits of the joints and of the TCP.
///
/// `ik` is queried at up to 100 poses, including the last one. Where `arm` deviates from it, as nominal
/// kinematics do from a calibrated arm, the deviation is a correction that is interpolated along the path.
///
/// Returns ErrorCode::invalid_goal, with the field, for numbers that are not finite or out of range, and
/// ErrorCode::unreachable, with the pose and the reason, if a pose is out of reach, a joint limit is
/// exceeded or the arm comes near a singularity (smallest singular value of the Jacobian below 0.01,
/// rotations scaled by 0.2 m).
Expected<trajectory::Trajectory> plan_cartesian(const std::vector<Pose> & poses, const Arm & arm,
                                                const Joints & start, const trajectory::Limits & limits,
                                                const CartesianOptions & options, const IkFunction & ik,
                                                const std::stop_token & stop = {});

}  // namespace ur_ros_rtde::kinematics
