#pragma once

#include <geometry_msgs/msg/pose_stamped.hpp>
#include <geometry_msgs/msg/twist_stamped.hpp>
#include <sensor_msgs/msg/joint_state.hpp>

#include "ur_ros_rtde/streaming.hpp"

namespace ur_ros_rtde {

/// Convert messages to targets. Errors name the field, its value and the allowed values.

/// All six positions by joint name, in any order. Names may have a prefix, and other joints are ignored.
Expected<StreamTarget> joint_target(const sensor_msgs::msg::JointState & message, const ArmLimits & limits);
/// In the frame `base`, with or without a prefix.
Expected<StreamTarget> pose_target(const geometry_msgs::msg::PoseStamped & message);
/// In the frame `base` or `tool0_controller`, with or without a prefix. A zero twist holds the arm.
Expected<StreamTarget> twist_target(const geometry_msgs::msg::TwistStamped & message);

}  // namespace ur_ros_rtde
