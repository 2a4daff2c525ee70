#include <gtest/gtest.h>

#include <limits>

#include "state/fake_joints.hpp"

namespace ur_ros_rtde {
namespace {
using sensor_msgs::msg::JointState;

JointState real()
{
  JointState state;
  state.name = {"a", "b", "c"};
  state.position = {1.0, 2.0, 3.0};
  state.velocity = {0.1, 0.2, 0.3};
  state.effort = {10.0, 20.0, 30.0};
  return state;
}

JointState message(std::vector<std::string> names, std::vector<double> positions)
{
  JointState state;
  state.name = std::move(names);
  state.position = std::move(positions);
  return state;
}

TEST(FakeJointsTest, AreInactiveBeforeBeginAndAfterEnd)
{
  FakeJoints fake;
  JointState shown = real();
  EXPECT_FALSE(fake.apply(shown));
  EXPECT_FALSE(fake.set(message({"a"}, {5.0})));
  fake.begin(real());
  EXPECT_TRUE(fake.apply(shown));
  fake.end();
  EXPECT_FALSE(fake.apply(shown));
}

TEST(FakeJointsTest, KeepThePositionsOfTheStartAtRest)
{
  FakeJoints fake;
  fake.begin(real());
  JointState shown = real();
  shown.position = {7.0, 8.0, 9.0};
  ASSERT_TRUE(fake.apply(shown));
  EXPECT_EQ(shown.position, real().position);
  EXPECT_EQ(shown.velocity, std::vector<double>(3, 0.0));
  EXPECT_EQ(shown.effort, std::vector<double>(3, 0.0));
}

TEST(FakeJointsTest, TakePositionsByNameInAnyOrder)
{
  FakeJoints fake;
  fake.begin(real());
  ASSERT_TRUE(fake.set(message({"c", "a"}, {-3.0, -1.0})));
  JointState shown = real();
  fake.apply(shown);
  EXPECT_EQ(shown.position, (std::vector<double>{-1.0, 2.0, -3.0}));
}

TEST(FakeJointsTest, IgnoreAnInvalidMessageAndNameTheCause)
{
  FakeJoints fake;
  fake.begin(real());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(fake.set(message({"a"}, {6.29})).error().find("6.29 rad, it must be -6.28319 to 6.28319"),
            std::string::npos);
  EXPECT_NE(fake.set(message({"a", "z"}, {5.0, 5.0})).error().find("\"z\""), std::string::npos);
  EXPECT_NE(fake.set(message({"a", "b"}, {5.0})).error().find("2 names and 1 positions"), std::string::npos);
  EXPECT_NE(fake.set(message({"a", "b"}, {5.0, nan})).error().find("nan"), std::string::npos);
  JointState shown = real();
  fake.apply(shown);
  EXPECT_EQ(shown.position, real().position);
}

}  // namespace
}  // namespace ur_ros_rtde
