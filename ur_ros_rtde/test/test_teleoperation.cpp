#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "teleoperation/publisher_pause.hpp"
#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/streaming.hpp"
#include "ur_ros_rtde/target_messages.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

sensor_msgs::msg::JointState joints(double first)
{
  sensor_msgs::msg::JointState message;
  message.name = {joint_names().begin(), joint_names().end()};
  message.position = {first, 0.1, 0.2, 0.3, 0.4, 0.5};
  return message;
}

std::string why_not(const Expected<StreamTarget> & target)
{
  return target ? "" : target.error().message;
}

TEST(JointTargetTest, IsReadByNameInAnyOrderWithPrefixAndOtherJoints)
{
  auto message = joints(0.7);
  std::reverse(message.name.begin(), message.name.end());
  std::reverse(message.position.begin(), message.position.end());
  for (auto & name : message.name) {
    name = "left_" + name;
  }
  message.name.insert(message.name.begin(), "finger_joint");
  message.position.insert(message.position.begin(), 0.02);
  const auto target = joint_target(message, widest_arm_limits(), "left_");
  ASSERT_TRUE(target) << why_not(target);
  EXPECT_FALSE(joint_target(message, widest_arm_limits(), "right_")) << "of another arm";
  EXPECT_EQ(target->values, (Vector6{0.7, 0.1, 0.2, 0.3, 0.4, 0.5}));
}

TEST(JointTargetTest, RejectionNamesTheField)
{
  auto missing = joints(0.0);
  missing.name.pop_back();
  missing.position.pop_back();
  EXPECT_EQ(why_not(joint_target(missing, widest_arm_limits())),
            "the message has no position of wrist_3_joint");
  auto twice = joints(0.0);
  twice.name.push_back("elbow_joint");
  twice.position.push_back(0.0);
  EXPECT_EQ(why_not(joint_target(twice, widest_arm_limits())),
            "the message has two positions of elbow_joint");
  auto short_of_positions = joints(0.0);
  short_of_positions.position.pop_back();
  EXPECT_NE(why_not(joint_target(short_of_positions, widest_arm_limits())), "");
  for (const double wrong : {nan, 6.3, -std::numeric_limits<double>::infinity()}) {
    EXPECT_NE(why_not(joint_target(joints(wrong), widest_arm_limits())).find("shoulder_pan_joint"),
              std::string::npos);
  }
}

TEST(PoseTargetTest, MustBeAValidPoseInTheBaseFrame)
{
  geometry_msgs::msg::PoseStamped message;
  EXPECT_NE(why_not(pose_target(message)).find("frame_id"), std::string::npos);
  message.header.frame_id = "base_link";
  EXPECT_NE(why_not(pose_target(message)).find("base_link"), std::string::npos);
  message.pose.position.z = 0.5;
  for (const char * frame : {"base", "left_base"}) {
    message.header.frame_id = frame;
    EXPECT_TRUE(pose_target(message, "left_")) << why_not(pose_target(message, "left_"));
  }
  for (const char * frame : {"right_base", "mobile_base", "left_left_base"}) {
    message.header.frame_id = frame;
    EXPECT_NE(why_not(pose_target(message, "left_")).find("also with the prefix left_"), std::string::npos)
        << frame;
  }
  message.header.frame_id = "left_base";
  EXPECT_NE(why_not(pose_target(message)).find("left_base"), std::string::npos)
      << "the prefix of another arm";
  message.header.frame_id = "base";
  message.pose.orientation.w = 0.0;
  EXPECT_NE(why_not(pose_target(message)).find("orientation"), std::string::npos);
}

TEST(TwistTargetTest, HasTwoFramesAndMayBeZero)
{
  geometry_msgs::msg::TwistStamped message;
  message.header.frame_id = "tool0_controller";
  const auto zero = twist_target(message);
  ASSERT_TRUE(zero) << why_not(zero);
  EXPECT_TRUE(zero->in_tool_frame);
  message.header.frame_id = "base";
  message.twist.linear.x = 0.2;
  EXPECT_FALSE(twist_target(message)->in_tool_frame);
  for (const double wrong : {nan, 3.2}) {
    message.twist.linear.x = wrong;
    EXPECT_NE(why_not(twist_target(message)).find("twist.linear"), std::string::npos);
  }
  message.header.frame_id = "right_tool0_controller";
  EXPECT_NE(why_not(twist_target(message, "left_")).find("right_tool0_controller"), std::string::npos);
  message.header.frame_id = "camera";
  EXPECT_NE(why_not(twist_target(message)).find("camera"), std::string::npos);
}

TEST(TargetPeriodTest, IsSmoothedAndStartsAnewAfterAPause)
{
  TargetPeriod period;
  constexpr double timeout = 0.1;
  EXPECT_DOUBLE_EQ(period.next(0.02, timeout), 0.05) << "unknown at the first target";
  double last = 0.05;
  for (int i = 0; i < 30; ++i) {
    const double next = period.next(0.02, timeout);
    EXPECT_LT(next, last);
    last = next;
  }
  EXPECT_NEAR(last, 0.02, 1e-3);
  EXPECT_DOUBLE_EQ(period.next(0.2, timeout), 0.05) << "the first one after a pause";
}

rcl_cxx::MessageInfo published_at(double time, std::optional<std::uint64_t> number = {})
{
  rcl_cxx::MessageInfo info;
  info.published += std::chrono::round<std::chrono::nanoseconds>(std::chrono::duration<double>(time));
  info.number = number;
  return info;
}

TEST(PublisherPauseTest, IsATimeWithoutMessages)
{
  constexpr double timeout = 0.1;
  EXPECT_TRUE(has_paused(published_at(1.0, 7), published_at(1.11, 8), timeout));
  EXPECT_FALSE(has_paused(published_at(1.0, 7), published_at(1.09, 8), timeout)) << "late on its way";
  EXPECT_FALSE(has_paused(published_at(1.0, 7), published_at(1.4, 27), timeout)) << "messages were lost";
  EXPECT_TRUE(has_paused(published_at(1.0), published_at(1.4), timeout)) << "they are not counted";
  auto other = published_at(1.02, 1);
  other.publisher[0] = 1;
  EXPECT_TRUE(has_paused(published_at(1.0, 7), other, timeout)) << "another publisher";
}

TEST(PublisherPauseTest, KnowsForHowLongAPublisherHasPublished)
{
  constexpr double shortest = 0.1;
  EXPECT_NEAR(age_of_publisher(published_at(10.5, 3), published_at(10.6, 8), shortest).value(), 0.14, 1e-6);
  EXPECT_NEAR(age_of_publisher(published_at(10.5, 50), published_at(10.7, 60), shortest).value(), 1.18, 1e-6);
  EXPECT_FALSE(age_of_publisher(published_at(10.5, 50), published_at(10.501, 51), shortest)) << "a burst";
  EXPECT_FALSE(age_of_publisher(published_at(10.5), published_at(10.6), shortest)) << "they are not counted";
}

TEST(TargetFollowerTest, RejectsATwistWithNan)
{
  const auto follower = follow_twists({});
  for (std::size_t i = 0; i < 6; ++i) {
    StreamTarget target;
    target.values[i] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(follower->set_target(target, 0.01)) << i;
  }
}

TEST(TargetFollowerTest, KnowsWhichTwistsCommandAMotion)
{
  const auto follower = follow_twists({});
  EXPECT_TRUE(follower->moves({{0.0, 0.01, 0.0, 0.0, 0.0, 0.0}}, nullptr, {}));
  EXPECT_TRUE(follower->moves({{0.0, 0.0, 0.0, 0.0, 0.0, -0.01}}, nullptr, {}));
  EXPECT_FALSE(follower->moves({{0.0, 0.0005, 0.0, 0.0, 0.0, 0.0}}, nullptr, {})) << "a stick at rest";
}

TEST(TargetFollowerTest, APositionCommandsNoMotionIfItIsThatOfTheArmAndOfTheMessageBefore)
{
  Sample sample{};
  sample.actual_q = {0.0, 0.1, 0.2, 0.3, 0.4, 0.5};
  sample.actual_tcp_pose = {0.4, 0.1, 0.3, 0.0, 3.1, 0.0};
  const StreamTarget far{{0.1, 0.1, 0.2, 0.3, 0.4, 0.5}}, near{{0.005, 0.1, 0.2, 0.3, 0.4, 0.5}};
  const auto joints = follow_joints({});
  EXPECT_FALSE(joints->moves(near, &near, sample));
  EXPECT_TRUE(joints->moves(near, nullptr, sample));
  EXPECT_TRUE(joints->moves(far, &far, sample));
  const StreamTarget next{{0.006, 0.1, 0.2, 0.3, 0.4, 0.5}};
  EXPECT_TRUE(joints->moves(next, &near, sample)) << "a program that goes on";

  const StreamTarget pose{{0.405, 0.1, 0.3, 0.0, 3.1, 0.0}}, turned{{0.405, 0.1, 0.3, 0.0, 3.05, 0.0}};
  const auto poses = follow_poses({});
  EXPECT_FALSE(poses->moves(pose, &pose, sample));
  EXPECT_TRUE(poses->moves(turned, &turned, sample));
  EXPECT_TRUE(poses->moves(pose, &turned, sample));
}

TEST(TargetFollowerTest, RejectsTargetFarFromTheArm)
{
  StreamOptions options;
  Sample sample{};
  sample.actual_q = {0.0, 0.1, 0.2, 0.3, 0.4, 0.5};
  const auto follower = follow_joints(options);
  follower->begin(sample, 0.002, widest_arm_limits());
  EXPECT_TRUE(follower->set_target({{0.15, 0.1, 0.2, 0.3, 0.4, 0.5}}, 0.02));
  const auto rejected = follower->set_target({{0.0, 0.1, 0.45, 0.3, 0.4, 0.5}}, 0.02);
  ASSERT_FALSE(rejected);
  EXPECT_NE(rejected.error().message.find("elbow_joint"), std::string::npos);
  EXPECT_FALSE(follower->set_target({{nan, 0.1, 0.2, 0.3, 0.4, 0.5}}, 0.02));
}

TEST(TargetFollowerTest, ChecksPositionAndRotationOfAPose)
{
  StreamOptions options;
  Sample sample{};
  sample.actual_tcp_pose = {0.4, 0.1, 0.3, 0.0, 3.1, 0.0};
  const auto follower = follow_poses(options);
  follower->begin(sample, 0.002, widest_arm_limits());
  EXPECT_TRUE(follower->set_target({{0.45, 0.1, 0.3, 0.0, 3.1, 0.0}}, 0.02));
  EXPECT_FALSE(follower->set_target({{0.55, 0.1, 0.3, 0.0, 3.1, 0.0}}, 0.02));
  EXPECT_FALSE(follower->set_target({{0.4, 0.1, 0.3, 0.0, 2.8, 0.0}}, 0.02));
  // The same orientation, written with the opposite axis, is no turn.
  EXPECT_TRUE(follower->set_target({{0.4, 0.1, 0.3, 0.0, 3.1 - 2.0 * 3.14159265358979, 0.0}}, 0.02));
}

TEST(TargetFollowerTest, NamesAMissingOrientation)
{
  Sample sample{};
  sample.actual_tcp_pose = {0.4, 0.1, 0.3, 0.0, 3.1, 0.0};
  const auto follower = follow_poses({});
  follower->begin(sample, 0.002, widest_arm_limits());
  const auto rejected = follower->set_target({{0.4, 0.1, 0.31, 0.0, 0.0, 0.0}}, 0.02);
  ASSERT_FALSE(rejected);
  EXPECT_NE(rejected.error().message.find("set the orientation in each message"), std::string::npos)
      << rejected.error().message;
  const auto turned = follower->set_target({{0.4, 0.1, 0.31, 0.0, 1.0, 0.0}}, 0.02);
  ASSERT_FALSE(turned);
  EXPECT_EQ(turned.error().message.find("only its position"), std::string::npos) << turned.error().message;
}
}  // namespace
}  // namespace ur_ros_rtde
