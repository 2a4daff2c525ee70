#pragma once

#include <chrono>
#include <geometry_msgs/msg/pose_stamped.hpp>
#include <geometry_msgs/msg/twist_stamped.hpp>
#include <geometry_msgs/msg/wrench_stamped.hpp>
#include <sensor_msgs/msg/joint_state.hpp>
#include <string>
#include <ur_ros_rtde_msgs/msg/io_state.hpp>

#include "state/effort_estimator.hpp"
#include "ur_ros_rtde_robot/state/sample.hpp"

namespace ur_ros_rtde {

builtin_interfaces::msg::Time to_time(std::chrono::system_clock::time_point stamp);

/// The messages of one control cycle with the same stamp: the time at which this host received the package.
/// Created once and filled without allocation.
struct StateMessages {
  /// Frames have the names of the official driver: `<tf_prefix>base` is the base frame of the controller,
  /// `<tf_prefix>tool0_controller` the active TCP.
  explicit StateMessages(const std::string & tf_prefix);

  void fill(const Sample & sample);

  sensor_msgs::msg::JointState joint_state;         ///< rad, rad/s, Nm (EffortEstimator)
  sensor_msgs::msg::JointState target_joint_state;  ///< setpoints of the controller; effort: target_moment
  geometry_msgs::msg::PoseStamped tcp_pose;         ///< of the TCP in `base`
  geometry_msgs::msg::TwistStamped tcp_speed;       ///< of the TCP in `base`; m/s, rad/s
  /// Force and torque that the environment exerts on the tool, at the TCP and in its orientation, in
  /// `tool0_controller`.
  geometry_msgs::msg::WrenchStamped wrench;
  ur_ros_rtde_msgs::msg::IOState io_state;

 private:
  void fill_tool(const Sample & sample);

  EffortEstimator efforts_;
};

}  // namespace ur_ros_rtde
