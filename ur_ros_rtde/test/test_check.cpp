#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/mode.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

std::string message(const Check & check)
{
  return check.error() ? check.error()->message : "";
}

TEST(CheckTest, AcceptsValuesInRangeIncludingTheBounds)
{
  Check check;
  check.in_range("a", 0.0, 0.0, 1.0).in_range("b", 1.0, 0.0, 1.0).above_zero("c", 3.0, 3.0);
  EXPECT_TRUE(check.ok()) << message(check);
}

TEST(CheckTest, NamesFieldValueLimitsAndUnit)
{
  Check check;
  check.in_range("lookahead_time", 0.5, 0.03, 0.2, "s");
  EXPECT_EQ(message(check), "lookahead_time is 0.5 s, it may be 0.03 to 0.2 s");
  EXPECT_EQ(check.error()->code, ErrorCode::invalid_goal);
}

TEST(CheckTest, KeepsTheFirstError)
{
  Check check;
  check.above_zero("speed", -1.0, 3.0).in_range("time", 9.0, 0.0, 1.0);
  EXPECT_NE(message(check).find("speed"), std::string::npos);
}

TEST(CheckTest, RejectsNanAndInfinity)
{
  for (const double value : {nan, infinity, -infinity}) {
    EXPECT_FALSE(Check().in_range("x", value, -1e300, 1e300).ok());
    EXPECT_FALSE(Check().above_zero("x", value, 1e300).ok());
    EXPECT_FALSE(Check().joints("x", {0.0, 0.0, 0.0, 0.0, 0.0, value}).ok());
    geometry_msgs::msg::Pose pose;
    pose.position.y = value;
    EXPECT_FALSE(Check().pose("x", pose).ok());
    pose.position.y = 0.0;
    pose.orientation.z = value;
    EXPECT_FALSE(Check().pose("x", pose).ok());
    geometry_msgs::msg::Twist twist;
    twist.angular.x = value;
    EXPECT_FALSE(Check().twist("x", twist).ok());
    geometry_msgs::msg::Vector3 vector;
    vector.z = value;
    EXPECT_FALSE(Check().vector("x", vector, 1.0).ok());
  }
}

TEST(CheckTest, RequiresSixJointsAndNamesThem)
{
  Check check;
  check.joints("joint_positions", {1.0, 2.0, 3.0});
  EXPECT_NE(message(check).find("joint_positions has 3 values, it must have 6: shoulder_pan_joint"),
            std::string::npos)
      << message(check);
}

TEST(CheckTest, NamesTheJointOutsideItsLimits)
{
  Check check;
  check.joints("joint_positions", {0.0, 0.0, -7.0, 0.0, 0.0, 0.0});
  EXPECT_NE(message(check).find("joint_positions[2] (elbow_joint) is -7 rad"), std::string::npos)
      << message(check);
}

TEST(CheckTest, RejectsAZeroQuaternionButNotAnUnnormalizedOne)
{
  geometry_msgs::msg::Pose pose;
  pose.orientation.w = 0.0;
  EXPECT_FALSE(Check().pose("pose", pose).ok());
  pose.orientation.x = 20.0;
  EXPECT_TRUE(Check().pose("pose", pose).ok());
}

TEST(CheckTest, RejectsAPoseOutOfReachOfAllModels)
{
  geometry_msgs::msg::Pose pose;
  pose.position.x = 5.0;
  Check check;
  check.pose("pose", pose);
  ASSERT_FALSE(check.ok());
  EXPECT_EQ(check.error()->code, ErrorCode::unreachable);
}

TEST(CheckTest, RejectsAZeroTwist)
{
  EXPECT_FALSE(Check().twist("twist", geometry_msgs::msg::Twist()).ok());
}

TEST(CheckTest, AcceptsOneLineOfText)
{
  EXPECT_TRUE(Check().line("text", "Grüße, 20 °C", 100).ok());
  EXPECT_FALSE(Check().line("text", "", 100).ok());
  EXPECT_FALSE(Check().line("text", "power off\nshutdown", 100).ok());
  EXPECT_FALSE(Check().line("text", std::string("a\0b", 3), 100).ok());
  EXPECT_FALSE(Check().line("text", "too long", 7).ok());
}

TEST(CheckForceModeTest, NamesWhatTheControlProgramWouldNotCheck)
{
  const auto problem = [](const ForceModeOptions & options) {
    Check check;
    return message(check_force_mode(check, options));
  };
  const ForceModeOptions valid{.compliant = {false, false, true, false, false, false},
                               .wrench = {0.0, 0.0, -10.0, 0.0, 0.0, 0.0}};
  EXPECT_EQ(problem(valid), "");
  ForceModeOptions options = valid;
  options.task_frame = {0.0, 0.0, 0.1};
  EXPECT_EQ(problem(options), "task_frame must have 6 finite values: position (m) and rotation vector (rad)");
  options = valid;
  options.compliant = {};
  EXPECT_EQ(problem(options), "compliant is false for all axes: at least one axis has to be true");
  options = valid;
  options.wrench[2] = 600.0;
  EXPECT_NE(problem(options).find("wrench.force"), std::string::npos);
  options.wrench[2] = nan;
  EXPECT_NE(problem(options).find("wrench.force"), std::string::npos);
  options = valid;
  options.limits[0] = 0.0;
  EXPECT_NE(problem(options).find("limits[0]"), std::string::npos);
}

TEST(ToUrTest, ConvertsAQuaternionToARotationVector)
{
  geometry_msgs::msg::Pose pose;
  pose.position.x = 0.1;
  pose.orientation.w = pose.orientation.z = std::sqrt(0.5);
  const auto converted = to_ur(pose);
  ASSERT_EQ(converted.size(), 6U);
  EXPECT_DOUBLE_EQ(converted[0], 0.1);
  EXPECT_NEAR(converted[5], std::acos(-1.0) / 2.0, 1e-12);
  pose.orientation.w = pose.orientation.z = 0.0;
  EXPECT_THROW(to_ur(pose), RobotError);
}

}  // namespace
}  // namespace ur_ros_rtde
