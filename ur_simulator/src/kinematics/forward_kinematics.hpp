#pragma once

#include <array>

#include "common/types.hpp"
#include "kinematics/robot_model.hpp"

namespace ur_simulator {

/// DH frames 1 to 6 in the base frame; the last is the tool flange.
std::array<Transform, 6> link_frames(const RobotModel & model, const Vector6 & joints);
/// Pose of the tool flange in the base frame.
Transform flange_pose(const RobotModel & model, const Vector6 & joints);
/// Pose of the TCP in the base frame; `tcp_offset` is the pose of the TCP in the flange frame.
Vector6 tcp_pose(const RobotModel & model, const Vector6 & joints, const Vector6 & tcp_offset);

/// Geometric Jacobian of the TCP in the base frame: [linear; angular] velocity = J * joint velocity.
Matrix6 jacobian(const RobotModel & model, const Vector6 & joints, const Vector6 & tcp_offset);
/// The same from the frames of link_frames() and the position of the TCP in the base frame.
Matrix6 jacobian(const std::array<Transform, 6> & frames, const Vector3 & tcp_position);
/// Time derivative dJ of the Jacobian at a joint velocity: TCP acceleration = J * qdd + dJ * qd.
Matrix6 jacobian_time_derivative(const RobotModel & model, const Vector6 & joints, const Vector6 & velocity,
                                 const Vector6 & tcp_offset);

}  // namespace ur_simulator
