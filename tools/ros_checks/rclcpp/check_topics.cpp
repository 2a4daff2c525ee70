#include <gmock/gmock.h>

#include <atomic>
#include <geometry_msgs/msg/twist_stamped.hpp>
#include <std_msgs/msg/bool.hpp>
#include <std_msgs/msg/float64.hpp>
#include <ur_ros_rtde_msgs/msg/driver_state.hpp>
#include <ur_ros_rtde_msgs/msg/robot_mode.hpp>
#include <ur_ros_rtde_msgs/msg/safety_mode.hpp>

#include "motion_test.hpp"

using geometry_msgs::msg::TwistStamped;
using sensor_msgs::msg::JointState;
using testing::SizeIs;
using ur_ros_rtde_msgs::msg::DriverState;

namespace {

class TopicCheck : public ClientTest {
 protected:
  /// Returns the message that a late subscription receives.
  template <typename Message>
  Message latched(const std::string & topic)
  {
    const MessageCollector<Message> heard(*node, topic, rclcpp::QoS(1).transient_local());
    if (!eventually([&] { return heard.count() > 0; })) {
      throw std::runtime_error("no message on " + topic);
    }
    return *heard.newest();
  }

  /// Subscribes to joint_states. Returns whether more than 100 messages are received.
  bool receives_joint_states(const rclcpp::QoS & qos)
  {
    const MessageCollector<JointState> heard(*node, "joint_states", qos);
    if (!eventually([&] { return heard.count() > 100; })) {
      return false;
    }
    const auto messages = heard.messages();
    for (std::size_t i = 1; i < messages.size(); ++i) {
      EXPECT_GT(rclcpp::Time(messages[i]->header.stamp), rclcpp::Time(messages[i - 1]->header.stamp));
      EXPECT_THAT(messages[i]->position, SizeIs(6));
    }
    return true;
  }
};

TEST_F(TopicCheck, JointStatesReachAReliableSubscription)
{
  EXPECT_TRUE(receives_joint_states(rclcpp::QoS(10)));
}

TEST_F(TopicCheck, JointStatesReachABestEffortSubscription)
{
  EXPECT_TRUE(receives_joint_states(rclcpp::SensorDataQoS()));
}

TEST_F(TopicCheck, TransientLocalSubscriptionToJointStatesIsReportedAsIncompatible)
{
  const auto incompatible = std::make_shared<std::atomic<int>>(RMW_QOS_POLICY_INVALID);
  rclcpp::SubscriptionOptions options;
  options.event_callbacks.incompatible_qos_callback =
      [incompatible](const rclcpp::QOSRequestedIncompatibleQoSInfo & info) {
        *incompatible = info.last_policy_kind;
      };
  const auto subscription = node->create_subscription<JointState>(
      "joint_states", rclcpp::QoS(1).transient_local(), [](const JointState &) { FAIL(); }, options);
  EXPECT_TRUE(eventually([&] { return *incompatible == RMW_QOS_POLICY_DURABILITY; }));
}

TEST_F(TopicCheck, LatchedTopicsReachALateSubscription)
{
  ASSERT_TRUE(eventually([&] { return latched<DriverState>("driver_state").state == DriverState::READY; },
                         motion_limit));
  EXPECT_EQ(latched<ur_ros_rtde_msgs::msg::RobotMode>("robot_mode").mode,
            ur_ros_rtde_msgs::msg::RobotMode::RUNNING);
  EXPECT_EQ(latched<ur_ros_rtde_msgs::msg::SafetyMode>("safety_mode").mode,
            ur_ros_rtde_msgs::msg::SafetyMode::NORMAL);
  EXPECT_TRUE(latched<std_msgs::msg::Bool>("program_running").data);
  EXPECT_GT(latched<std_msgs::msg::Float64>("speed_scaling").data, 0.0);
}

TEST_F(MotionTest, PublishedTwistMovesTheArmAndStopsWithThePublisher)
{
  const auto publisher =
      node->create_publisher<TwistStamped>("twist", rclcpp::QoS(1));  // reliable, as rclcpp's default
  ASSERT_TRUE(eventually([&] { return publisher->get_subscription_count() == 1; }));
  const auto timer = node->create_wall_timer(10ms, [publisher, node = node] {
    TwistStamped message;
    message.header.stamp = node->now();
    message.header.frame_id = "base";
    message.twist.linear.z = 0.05;
    publisher->publish(message);
  });
  EXPECT_TRUE(eventually([&] { return arm.speed() > 0.02; }));
  timer->cancel();
  EXPECT_TRUE(eventually([&] { return arm.at_rest(); }));
}

}  // namespace
