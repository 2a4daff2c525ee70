#pragma once

#include <geometry_msgs/msg/pose_stamped.hpp>
#include <geometry_msgs/msg/twist_stamped.hpp>
#include <sensor_msgs/msg/joint_state.hpp>
#include <string>

#include "ur_ros_rtde/streaming.hpp"

namespace ur_ros_rtde {

/// Convert messages to targets. Errors name the field, its value and the allowed values. Names of joints and
/// frames may have the `prefix` of this arm (CommandHost::Options::tf_prefix), but not that of another one.

/// All six positions by joint name, in any order. Other joints are ignored.
Expected<StreamTarget> joint_target(const sensor_msgs::msg::JointState & message, const ArmLimits & limits,
                                    const std::string & prefix = {});
/// In the frame `base`.
Expected<StreamTarget> pose_target(const geometry_msgs::msg::PoseStamped & message,
                                   const std::string & prefix = {});
/// In the frame `base` or `tool0_controller`. A zero twist holds the arm.
Expected<StreamTarget> twist_target(const geometry_msgs::msg::TwistStamped & message,
                                    const std::string & prefix = {});

}  // namespace ur_ros_rtde
