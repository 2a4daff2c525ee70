#pragma once

#include <geometry_msgs/msg/pose_stamped.hpp>
#include <memory>
#include <rcl_cxx/node.hpp>
#include <string>

namespace ur_ros_rtde {

/// Broadcasts the TCP pose on /tf, as the official driver does: `<tf_prefix>base` ->
/// `<tf_prefix>tool0_controller`.
class ToolTransform {
 public:
  virtual ~ToolTransform() = default;
  /// Sends nothing while /tf has no subscriber. Allocates nothing.
  virtual void publish(const geometry_msgs::msg::PoseStamped & tcp_pose) = 0;
};

/// Null, and a line in the log, in a build without the package tf2_msgs.
std::unique_ptr<ToolTransform> make_tool_transform(rcl_cxx::Node & node, const std::string & tf_prefix);

}  // namespace ur_ros_rtde
