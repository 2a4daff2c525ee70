#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ur_ros_rtde/tcp_target.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double pi = std::numbers::pi;

geometry_msgs::msg::Pose pose(double x, double y, double z)
{
  geometry_msgs::msg::Pose message;
  message.position.x = x;
  message.position.y = y;
  message.position.z = z;
  return message;
}

/// The same, turned about x.
geometry_msgs::msg::Pose turned(double angle)
{
  auto message = pose(0.5, 0.1, 0.4);
  message.orientation.x = std::sin(angle / 2.0);
  message.orientation.w = std::cos(angle / 2.0);
  return message;
}

Sample looking_down()
{
  Sample sample{};
  sample.target_tcp_pose = {0.4, 0.0, 0.3, pi, 0.0, 0.0};
  return sample;
}

TEST(TcpTargetTest, PositionOnlyKeepsTheOrientation)
{
  EXPECT_EQ(tcp_target(pose(0.5, 0.1, 0.4), false, looking_down()),
            (std::vector<double>{0.5, 0.1, 0.4, pi, 0.0, 0.0}));
}

TEST(TcpTargetTest, UsesAnExplicitIdentityOrientation)
{
  EXPECT_EQ(tcp_target(pose(0.5, 0.1, 0.4), true, looking_down()),
            (std::vector<double>{0.5, 0.1, 0.4, 0.0, 0.0, 0.0}));
}

TEST(TcpTargetTest, UsesAnyOtherOrientation)
{
  const auto nearly = turned(1e-7);
  EXPECT_FALSE(has_identity_orientation(nearly));
  EXPECT_NEAR(tcp_target(nearly, false, looking_down())[3], 1e-7, 1e-12);
  auto negative = pose(0.5, 0.1, 0.4);
  negative.orientation.w = -1.0;  // the same rotation, but no default
  EXPECT_NEAR(tcp_target(negative, false, looking_down())[3], 0.0, 1e-12);
}

TEST(IdentityOrientationWarningTest, NamesTheFirstPoseWithAnIdentityOrientation)
{
  const Vector6 start = looking_down().target_tcp_pose;
  const auto text = identity_orientation_warning(
      start, path_poses("poses", {turned(pi), turned(0.9 * pi), pose(0.5, 0.1, 0.4), pose(0.6, 0.1, 0.4)}));
  EXPECT_EQ(text.find("poses[2] turns the tool by 162 degrees"), 0U) << text;
}

TEST(IdentityOrientationWarningTest, IgnoresOtherAndSmallRotations)
{
  const Vector6 start = looking_down().target_tcp_pose;
  EXPECT_EQ(identity_orientation_warning(start, path_poses("poses", {turned(0.1)})), "")
      << "an orientation of its own";
  EXPECT_EQ(identity_orientation_warning(
                start, path_poses("poses", {turned(0.6 * pi), turned(0.3 * pi), pose(1, 0, 0)})),
            "");
  EXPECT_NE(identity_orientation_warning(start, path_poses("poses", {turned(0.6 * pi), pose(1, 0, 0)})), "");
}

TEST(IdentityOrientationWarningTest, IsUnknownAfterJointPositions)
{
  const Vector6 start = looking_down().target_tcp_pose;
  EXPECT_EQ(identity_orientation_warning(
                start, {{"waypoints[0]", std::nullopt}, {"waypoints[1].pose", pose(1, 0, 0)}}),
            "");
}

}  // namespace
}  // namespace ur_ros_rtde
