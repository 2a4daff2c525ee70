#pragma once

#include <geometry_msgs/msg/pose_stamped.hpp>
#include <geometry_msgs/msg/twist_stamped.hpp>
#include <sensor_msgs/msg/joint_state.hpp>

#include "teleoperation/follower.hpp"

namespace ur_ros_rtde {

/// What a message asks for; the error names the field, its value and what it may be.

/// Positions by name, in any order, all six; names may have a prefix, and there may be others.
Expected<StreamTarget> joint_target(const sensor_msgs::msg::JointState & message, const ArmLimits & limits);
/// In `base`, with a prefix or without.
Expected<StreamTarget> pose_target(const geometry_msgs::msg::PoseStamped & message);
/// In `base` or `tool0_controller`. Zero holds the arm still.
Expected<StreamTarget> twist_target(const geometry_msgs::msg::TwistStamped & message);

}  // namespace ur_ros_rtde
