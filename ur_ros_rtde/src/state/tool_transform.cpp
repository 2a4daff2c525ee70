#include "state/tool_transform.hpp"

namespace ur_ros_rtde {

/// Topic and quality of service of tf2_ros::TransformBroadcaster: every listener asks for reliable messages.
ToolTransform::ToolTransform(rcl_cxx::Node & node, const std::string & tf_prefix)
    : publisher_(node.create_publisher<tf2_msgs::msg::TFMessage>("/tf", rcl_cxx::QoS::reliable(100)))
{
  message_.transforms.resize(1);
  message_.transforms[0].child_frame_id = tf_prefix + "tool0_controller";
}

void ToolTransform::publish(const geometry_msgs::msg::PoseStamped & tcp_pose)
{
  if (publisher_->get_subscription_count() == 0) {
    return;
  }
  auto & transform = message_.transforms[0];
  transform.header = tcp_pose.header;
  transform.transform.translation.x = tcp_pose.pose.position.x;
  transform.transform.translation.y = tcp_pose.pose.position.y;
  transform.transform.translation.z = tcp_pose.pose.position.z;
  transform.transform.rotation = tcp_pose.pose.orientation;
  publisher_->publish(message_);
}

}  // namespace ur_ros_rtde
