#pragma once

#include <array>

#include "common/types.hpp"
#include "kinematics/robot_model.hpp"

namespace ur_simulator {

/// Frames 1..6 of the DH chain in the base frame; the last is the tool flange.
std::array<Transform, 6> link_frames(const RobotModel & model, const Vector6 & joints);
/// The tool flange in the base frame.
Transform forward_flange(const RobotModel & model, const Vector6 & joints);
/// The TCP in the base frame, `tcp_offset` being the pose of the TCP in the flange frame.
Vector6 forward_tcp(const RobotModel & model, const Vector6 & joints, const Vector6 & tcp_offset);

/// Geometric Jacobian of the TCP in the base frame: [linear; angular] velocity = J * joint velocity.
Matrix6 jacobian(const RobotModel & model, const Vector6 & joints, const Vector6 & tcp_offset);
/// The same from frames already known (link_frames) and the TCP's position in the base frame.
Matrix6 jacobian(const std::array<Transform, 6> & frames, const Vector3 & tcp_position);
/// Its derivative in time at the joint velocity given: TCP acceleration = J * qdd + dJ * qd.
Matrix6 jacobian_time_derivative(const RobotModel & model, const Vector6 & joints, const Vector6 & velocity,
                                 const Vector6 & tcp_offset);

}  // namespace ur_simulator
