#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "state/state_messages.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double pi = 3.14159265358979323846;

Sample sample()
{
  Sample made{};
  made.stamp = std::chrono::system_clock::time_point(std::chrono::nanoseconds(1'700'000'000'123'456'789));
  made.actual_q = {1, 2, 3, 4, 5, 6};
  made.actual_qd = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  made.actual_current_as_torque = {10, 20, 30, 40, 50, 60};
  made.actual_tcp_pose = {0.4, -0.2, 0.3, 0.0, pi, 0.0};  // the tool looks down
  made.actual_tcp_speed = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  made.target_q = {6, 5, 4, 3, 2, 1};
  made.target_moment = {1, 2, 3, 4, 5, 6};
  made.actual_tcp_force = {1.0, 2.0, 5.0, 0.1, 0.2, 0.5};
  made.digital_inputs = (1U << 3U) | (1U << 17U);
  made.digital_outputs = 1U << 8U;
  made.analog_inputs = {0.004, 5.0};
  return made;
}

TEST(StateMessagesTest, HaveTheSameStamp)
{
  StateMessages messages("");
  messages.fill(sample());
  EXPECT_EQ(messages.joint_state.header.stamp.sec, 1'700'000'000);
  EXPECT_EQ(messages.joint_state.header.stamp.nanosec, 123'456'789U);
  EXPECT_EQ(messages.tcp_pose.header.stamp, messages.joint_state.header.stamp);
  EXPECT_EQ(messages.wrench.header.stamp, messages.joint_state.header.stamp);
  EXPECT_EQ(messages.io_state.header.stamp, messages.joint_state.header.stamp);
  EXPECT_EQ(messages.tcp_speed.header.stamp, messages.joint_state.header.stamp);
  EXPECT_EQ(messages.target_joint_state.header.stamp, messages.joint_state.header.stamp);
}

TEST(StateMessagesTest, HaveThePrefixInJointsAndFrames)
{
  StateMessages messages("left_");
  ASSERT_EQ(messages.joint_state.name.size(), 6U);
  EXPECT_EQ(messages.joint_state.name[0], "left_shoulder_pan_joint");
  EXPECT_EQ(messages.joint_state.name[5], "left_wrist_3_joint");
  EXPECT_EQ(messages.tcp_pose.header.frame_id, "left_base");
  EXPECT_EQ(messages.wrench.header.frame_id, "left_tool0_controller");
}

TEST(StateMessagesTest, ConvertTheRotationVectorToAQuaternion)
{
  StateMessages messages("");
  messages.fill(sample());
  const auto & q = messages.tcp_pose.pose.orientation;
  EXPECT_NEAR(std::abs(q.y), 1.0, 1e-12);
  EXPECT_NEAR(q.w, 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(messages.tcp_pose.pose.position.x, 0.4);
}

TEST(StateMessagesTest, HaveTheWrenchInTheOrientationOfTheTool)
{
  StateMessages messages("");
  messages.fill(sample());
  const auto & wrench = messages.wrench.wrench;
  EXPECT_NEAR(wrench.force.x, -1.0, 1e-12);
  EXPECT_NEAR(wrench.force.y, 2.0, 1e-12);
  EXPECT_NEAR(wrench.force.z, -5.0, 1e-12);
  EXPECT_NEAR(wrench.torque.z, -0.5, 1e-12);
}

TEST(StateMessagesTest, HaveTheTcpSpeedInTheBaseFrameAndTheSetpoints)
{
  StateMessages messages("left_");
  messages.fill(sample());
  EXPECT_EQ(messages.tcp_speed.header.frame_id, "left_base");
  EXPECT_DOUBLE_EQ(messages.tcp_speed.twist.linear.z, 0.3);
  EXPECT_DOUBLE_EQ(messages.tcp_speed.twist.angular.x, 0.4);
  EXPECT_EQ(messages.target_joint_state.name, messages.joint_state.name);
  EXPECT_EQ(messages.target_joint_state.position, (std::vector<double>{6, 5, 4, 3, 2, 1}));
  EXPECT_EQ(messages.target_joint_state.effort, (std::vector<double>{1, 2, 3, 4, 5, 6}));
}

TEST(StateMessagesTest, HaveEachPinAtItsNumber)
{
  StateMessages messages("");
  messages.fill(sample());
  for (std::size_t pin = 0; pin < 18; ++pin) {
    EXPECT_EQ(messages.io_state.digital_inputs[pin], pin == 3 || pin == 17) << pin;
    EXPECT_EQ(messages.io_state.digital_outputs[pin], pin == 8) << pin;
  }
  EXPECT_DOUBLE_EQ(messages.io_state.analog_inputs[1], 5.0);
}

TEST(StateMessagesTest, AreFilledWithoutReallocation)
{
  StateMessages messages("");
  messages.fill(sample());
  const double * positions = messages.joint_state.position.data();
  messages.fill(sample());
  EXPECT_EQ(messages.joint_state.position.data(), positions);
}

TEST(EffortEstimatorTest, UsesTheReportedTorque)
{
  EXPECT_EQ(EffortEstimator().update(sample()), (Vector6{10, 20, 30, 40, 50, 60}));
}

TEST(EffortEstimatorTest, FitsTheTargetsWithoutAReportedTorque)
{
  Sample made = sample();
  made.actual_current_as_torque.fill(std::numeric_limits<double>::quiet_NaN());
  EffortEstimator estimator;
  Vector6 efforts{};
  for (int i = 0; i < 500; ++i) {
    made.target_current.fill(1.0 + 0.001 * i);
    made.target_moment.fill(12.0 * (1.0 + 0.001 * i));
    made.actual_current.fill(2.0);
    efforts = estimator.update(made);
  }
  EXPECT_NEAR(efforts[0], 24.0, 1e-9);
}

TEST(EffortEstimatorTest, UsesTheTargetBeforeTheFirstCurrent)
{
  Sample made = sample();
  made.actual_current_as_torque.fill(std::numeric_limits<double>::quiet_NaN());
  made.target_moment.fill(3.0);
  EXPECT_EQ(EffortEstimator().update(made)[2], 3.0);
}

}  // namespace
}  // namespace ur_ros_rtde
