#include "state/tool_transform.hpp"

#if __has_include(<tf2_msgs/msg/tf_message.hpp>)
#include <tf2_msgs/msg/tf_message.hpp>

namespace ur_ros_rtde {
namespace {

class TfPublisher : public ToolTransform {
 public:
  /// Topic and quality of service of tf2_ros::TransformBroadcaster: every listener asks for reliable
  /// messages.
  TfPublisher(rcl_cxx::Node & node, const std::string & tf_prefix)
      : publisher_(node.create_publisher<tf2_msgs::msg::TFMessage>("/tf", rcl_cxx::QoS::reliable(100)))
  {
    message_.transforms.resize(1);
    message_.transforms[0].child_frame_id = tf_prefix + "tool0_controller";
  }

  void publish(const geometry_msgs::msg::PoseStamped & tcp_pose) override
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

 private:
  rcl_cxx::Publisher<tf2_msgs::msg::TFMessage>::SharedPtr publisher_;
  tf2_msgs::msg::TFMessage message_;
};

}  // namespace

std::unique_ptr<ToolTransform> make_tool_transform(rcl_cxx::Node & node, const std::string & tf_prefix)
{
  return std::make_unique<TfPublisher>(node, tf_prefix);
}

}  // namespace ur_ros_rtde

#else

namespace ur_ros_rtde {

std::unique_ptr<ToolTransform> make_tool_transform(rcl_cxx::Node & node, const std::string & tf_prefix)
{
  RCL_CXX_INFO(
      node.get_logger(),
      "publish_tf is true, but this build cannot broadcast {}tool0_controller on /tf: tf2_msgs was not "
      "found. Install tf2_msgs and build ur_ros_rtde again, or set publish_tf to false",
      tf_prefix);
  return nullptr;
}

}  // namespace ur_ros_rtde
#endif
