#include "teleoperation/teleoperation.hpp"

#include "ur_ros_rtde/target_messages.hpp"

namespace ur_ros_rtde {

Teleoperation::Teleoperation(CommandHost & host, const StreamOptions & options, const LogFunction & log)
    : states_(host.node().create_publisher<TeleopReports::State>("teleoperation",
                                                                 rcl_cxx::QoS::transient_local(10))),
      joints_(host.node().resolve_topic_name("servo_joint"), host, options, follow_joints(options), log,
              publish_state(host)),
      poses_(host.node().resolve_topic_name("servo_pose"), host, options, follow_poses(options), log,
             publish_state(host)),
      twists_(host.node().resolve_topic_name("twist"), host, options, follow_twists(options), log,
              publish_state(host)),
      group_(host.node().create_callback_group())
{
  // A lost message is not worth a retransmission.
  const auto newest_only = rcl_cxx::QoS::best_effort(1);
  joint_messages_ = host.node().create_subscription<sensor_msgs::msg::JointState>(
      "servo_joint", newest_only,
      [this, &host](const sensor_msgs::msg::JointState & m, const rcl_cxx::MessageInfo & info) {
        joints_.on_message(joint_target(m, host.limits(), host.options().tf_prefix), info);
      },
      group_);
  pose_messages_ = host.node().create_subscription<geometry_msgs::msg::PoseStamped>(
      "servo_pose", newest_only,
      [this, &host](const geometry_msgs::msg::PoseStamped & m, const rcl_cxx::MessageInfo & info) {
        poses_.on_message(pose_target(m, host.options().tf_prefix), info);
      },
      group_);
  twist_messages_ = host.node().create_subscription<geometry_msgs::msg::TwistStamped>(
      "twist", newest_only,
      [this, &host](const geometry_msgs::msg::TwistStamped & m, const rcl_cxx::MessageInfo & info) {
        twists_.on_message(twist_target(m, host.options().tf_prefix), info);
      },
      group_);
}

TeleopReports::Publish Teleoperation::publish_state(CommandHost & host) const
{
  return [this, &host](TeleopReports::State state) {
    state.stamp = host.node().now();
    states_->publish(state);
  };
}

void Teleoperation::stop(const Error & why)
{
  for (TeleopTopic * topic : {&joints_, &poses_, &twists_}) {
    topic->stop(why);
  }
}

void Teleoperation::close()
{
  stop(Error{ErrorCode::shutdown, "the node is being shut down"});
  joints_.close();
  poses_.close();
  twists_.close();
}

}  // namespace ur_ros_rtde
