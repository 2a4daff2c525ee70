#pragma once

#include <geometry_msgs/msg/pose_stamped.hpp>
#include <geometry_msgs/msg/twist_stamped.hpp>
#include <memory>
#include <rcl_cxx/node.hpp>
#include <sensor_msgs/msg/joint_state.hpp>

#include "teleoperation/teleop_topic.hpp"

namespace ur_ros_rtde {

/// The topics servo_joint, servo_pose and twist, and `teleoperation`, which tells their state.
class Teleoperation {
 public:
  Teleoperation(CommandHost & host, const StreamOptions & options, const LogFunction & log);
  /// Of the messages: what else the node answers does not delay them.
  const rcl_cxx::CallbackGroup & group() const { return *group_; }
  /// Tells all sessions to end and starts no other. Returns at once.
  void stop(const Error & why);
  /// Calls stop() and waits for their end.
  void close();

 private:
  TeleopReports::Publish publish_state(CommandHost & host) const;

  const rcl_cxx::Publisher<TeleopReports::State>::SharedPtr states_;
  TeleopTopic joints_, poses_, twists_;
  rcl_cxx::CallbackGroup::SharedPtr group_;
  rcl_cxx::Subscription<sensor_msgs::msg::JointState>::SharedPtr joint_messages_;
  rcl_cxx::Subscription<geometry_msgs::msg::PoseStamped>::SharedPtr pose_messages_;
  rcl_cxx::Subscription<geometry_msgs::msg::TwistStamped>::SharedPtr twist_messages_;
};

}  // namespace ur_ros_rtde
