#pragma once

#include <geometry_msgs/msg/pose_stamped.hpp>
#include <geometry_msgs/msg/wrench_stamped.hpp>
#include <sensor_msgs/msg/joint_state.hpp>
#include <string>
#include <ur_ros_rtde_msgs/msg/io_state.hpp>

#include "nodes/effort_estimator.hpp"
#include "ur_ros_rtde/sample.hpp"

namespace ur_ros_rtde {

/// The messages of one control cycle, all with the same stamp: when this host had the package. Made once and
/// then filled without allocation.
struct StateMessages {
  /// Frames, as the official driver names them: `<tf_prefix>base` is the controller's base frame,
  /// `<tf_prefix>tool0_controller` the active TCP.
  explicit StateMessages(const std::string & tf_prefix);

  void fill(const Sample & sample);

  sensor_msgs::msg::JointState joint_state;  ///< rad, rad/s, Nm (EffortEstimator)
  geometry_msgs::msg::PoseStamped tcp_pose;  ///< of the TCP in `base`
  /// What the surroundings exert on the tool, at the TCP and in its orientation, in `tool0_controller`.
  geometry_msgs::msg::WrenchStamped wrench;
  ur_ros_rtde_msgs::msg::IOState io_state;

 private:
  EffortEstimator efforts_;
};

}  // namespace ur_ros_rtde
