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
  /// Publishes only while /tf has subscribers. Does not allocate.
  virtual void publish(const geometry_msgs::msg::PoseStamped & tcp_pose) = 0;
};

/// Returns null and logs a message if the package tf2_msgs was not available at build time.
std::unique_ptr<ToolTransform> make_tool_transform(rcl_cxx::Node & node, const std::string & tf_prefix);

}  // namespace ur_ros_rtde
