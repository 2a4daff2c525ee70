#pragma once

#include <geometry_msgs/msg/pose_stamped.hpp>
#include <rcl_cxx/node.hpp>
#include <string>
#include <tf2_msgs/msg/tf_message.hpp>

namespace ur_ros_rtde {

/// Broadcasts the TCP pose on /tf, as the official driver does: `<tf_prefix>base` ->
/// `<tf_prefix>tool0_controller`.
class ToolTransform {
 public:
  ToolTransform(rcl_cxx::Node & node, const std::string & tf_prefix);

  /// Publishes only while /tf has subscribers. Does not allocate.
  void publish(const geometry_msgs::msg::PoseStamped & tcp_pose);

 private:
  rcl_cxx::Publisher<tf2_msgs::msg::TFMessage>::SharedPtr publisher_;
  tf2_msgs::msg::TFMessage message_;
};

}  // namespace ur_ros_rtde
