#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <geometry_msgs/msg/pose_stamped.hpp>
#include <limits>
#include <numbers>

#include "ur_ros_rtde/detail/frame_tree.hpp"
#include "ur_ros_rtde/detail/goal_in_base.hpp"
#include "ur_ros_rtde_msgs/action/move_l.hpp"
#include "ur_ros_rtde_msgs/action/move_path.hpp"

namespace ur_ros_rtde {
namespace {

using std::chrono::milliseconds;
constexpr double half_turn = std::numbers::pi;
constexpr double quarter_turn = 0.5 * std::numbers::pi;
const FrameTree::Clock::time_point now = FrameTree::Clock::time_point(std::chrono::hours(1));

/// Turned about z.
geometry_msgs::msg::TransformStamped transform(const std::string & parent, const std::string & child,
                                               const std::array<double, 3> & position, double angle = 0.0)
{
  geometry_msgs::msg::TransformStamped result;
  result.header.frame_id = parent;
  result.child_frame_id = child;
  result.transform.translation.x = position[0];
  result.transform.translation.y = position[1];
  result.transform.translation.z = position[2];
  result.transform.rotation.z = std::sin(angle / 2.0);
  result.transform.rotation.w = std::cos(angle / 2.0);
  return result;
}

void expect_near(const Expected<Vector6> & pose, const Vector6 & expected)
{
  ASSERT_TRUE(pose) << pose.error().message;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR((*pose)[i], expected[i], 1e-12) << i;
  }
}

/// The base is turned by 90 degrees in base_link; the table stands in `world`.
FrameTree cell()
{
  FrameTree tree;
  tree.add(transform("world", "base_link", {1.0, 0.0, 0.5}), std::nullopt);
  tree.add(transform("base_link", "base", {0.0, 0.0, 0.0}, quarter_turn), std::nullopt);
  tree.add(transform("world", "table", {1.0, 2.0, 0.5}), std::nullopt);
  tree.add(transform("table", "part", {0.1, 0.0, 0.02}, quarter_turn), now);
  return tree;
}

TEST(FrameTreeTest, GoesUpAndDown)
{
  const FrameTree tree = cell();
  expect_near(tree.pose("base_link", "base", now), {0.0, 0.0, 0.0, 0.0, 0.0, -quarter_turn});
  expect_near(tree.pose("world", "base", now), {0.0, 1.0, -0.5, 0.0, 0.0, -quarter_turn});
  expect_near(tree.pose("part", "base", now), {2.0, -0.1, 0.02, 0.0, 0.0, 0.0});
}

TEST(FrameTreeTest, UsesTheNewestTransform)
{
  FrameTree tree = cell();
  tree.add(transform("table", "part", {0.3, 0.0, 0.02}, quarter_turn), now);
  expect_near(tree.pose("part", "base", now), {2.0, -0.3, 0.02, 0.0, 0.0, 0.0});
}

TEST(FrameTreeTest, NamesWhatIsMissing)
{
  FrameTree tree = cell();
  tree.add(transform("map", "camera", {0.0, 0.0, 0.0}), std::nullopt);
  EXPECT_EQ(tree.pose("tabel", "base", now).error().message, "TF has no frame \"tabel\"");
  EXPECT_EQ(tree.pose("table", "left_base", now).error().message, "TF has no frame \"left_base\"");
  EXPECT_EQ(tree.pose("camera", "base", now).error().message,
            "TF does not connect \"camera\" with \"base\": their trees begin with \"map\" and \"world\"");
}

TEST(FrameTreeTest, DoesNotUseATransformThatIsOld)
{
  const FrameTree tree = cell();
  EXPECT_TRUE(tree.pose("part", "base", now + FrameTree::longest_age));
  const auto late = tree.pose("part", "base", now + FrameTree::longest_age + milliseconds(500));
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().message,
            "the transform from \"table\" to \"part\" was published 2.5 s ago, the limit is 2 s");
  EXPECT_TRUE(tree.pose("table", "base", now + std::chrono::hours(1)));
}

geometry_msgs::msg::TransformStamped at(int milliseconds_of_stamp, geometry_msgs::msg::TransformStamped frame)
{
  frame.header.stamp.sec = 100;
  frame.header.stamp.nanosec = static_cast<std::uint32_t>(milliseconds_of_stamp) * 1000000U;
  return frame;
}

/// A camera on the arm has seen a part; then the arm moves on.
TEST(FrameTreeTest, APartStaysWhereItWasSeen)
{
  FrameTree tree;
  for (int i = 0; i <= 10; ++i) {
    tree.add(at(50 * i, transform("base", "camera", {0.01 * i, 0.0, 1.0}, 0.1 * i)), now);
  }
  tree.add(at(225, transform("camera", "part", {0.0, 0.0, 0.3})), now);
  expect_near(tree.pose("part", "base", now), {0.045, 0.0, 1.3, 0.0, 0.0, 0.45});
  tree.add(at(400, transform("camera", "part", {0.0, 0.0, 0.3})), now);
  expect_near(tree.pose("part", "base", now), {0.08, 0.0, 1.3, 0.0, 0.0, 0.8});
}

TEST(FrameTreeTest, NeedsACommonTime)
{
  FrameTree tree;
  tree.add(at(500, transform("base", "camera", {0.0, 0.0, 1.0})), now);
  tree.add(at(400, transform("camera", "part", {0.0, 0.0, 0.3})), now);
  EXPECT_EQ(
      tree.pose("part", "base", now).error().message,
      "TF does not tell where \"camera\" was when the other frames on the way from \"base\" to \"part\" "
      "were seen last");
  tree.add(at(600, transform("camera", "part", {0.0, 0.0, 0.3})), now);
  EXPECT_TRUE(tree.pose("part", "base", now));
}

TEST(FrameTreeTest, ForgetsAnOlderTransformAndAClockThatWasSetBack)
{
  FrameTree tree;
  tree.add(at(500, transform("base", "part", {0.5, 0.0, 0.0})), now);
  tree.add(at(600, transform("base", "part", {0.6, 0.0, 0.0})), now);
  tree.add(at(550, transform("base", "part", {0.55, 0.0, 0.0})), now);  // late
  expect_near(tree.pose("part", "base", now), {0.6, 0.0, 0.0, 0.0, 0.0, 0.0});
  tree.add(at(100, transform("base", "part", {0.1, 0.0, 0.0})), now);  // a simulation was started anew
  expect_near(tree.pose("part", "base", now), {0.1, 0.0, 0.0, 0.0, 0.0, 0.0});
}

TEST(FrameTreeTest, ForgetsFramesThatAreNoLongerPublished)
{
  FrameTree tree = cell();
  const auto later = now + std::chrono::minutes(2);
  tree.add(transform("table", "other", {0.0, 0.0, 0.0}), later);
  EXPECT_EQ(tree.pose("part", "base", later).error().message, "TF has no frame \"part\"");
  EXPECT_TRUE(tree.pose("other", "base", later));
}

TEST(FrameTreeTest, EndsInALoop)
{
  FrameTree tree;
  tree.add(transform("base", "a", {0.0, 0.0, 0.0}), now);
  tree.add(transform("a", "base", {0.0, 0.0, 0.0}), now);
  EXPECT_EQ(tree.pose("a", "base", now).error().message, "the frames above \"a\" form a loop");
}

TEST(FrameTreeTest, IgnoresWhatIsNoTransform)
{
  FrameTree tree = cell();
  auto no_rotation = transform("table", "part", {9.0, 0.0, 0.0});
  no_rotation.transform.rotation.w = 0.0;
  tree.add(no_rotation, now);
  tree.add(transform("table", "part", {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}), now);
  tree.add(transform("part", "part", {9.0, 0.0, 0.0}), now);
  expect_near(tree.pose("part", "base", now), {2.0, -0.1, 0.02, 0.0, 0.0, 0.0});
}

TEST(InBaseTest, KeepsAnOrientationThatIsNotValid)
{
  geometry_msgs::msg::Pose pose;
  pose.position.x = 0.1;
  pose.orientation.w = 0.0;
  const auto result = in_base({1.0, 0.0, 0.0, 0.0, 0.0, half_turn}, pose);
  EXPECT_NEAR(result.position.x, 0.9, 1e-12);
  EXPECT_EQ(result.orientation, pose.orientation);
}

TEST(InBaseTest, ChangesEveryPoseOfAGoal)
{
  ur_ros_rtde_msgs::action::MovePath::Goal goal;
  goal.waypoints.resize(2);
  for_each_pose(goal, [](geometry_msgs::msg::Pose & pose) { pose.position.x += 1.0; });
  for (const auto & waypoint : goal.waypoints) {
    EXPECT_EQ(waypoint.pose.position.x, 1.0);
    EXPECT_EQ(waypoint.via.position.x, 1.0);
  }
}

struct Poses {
  std::string frame_id;
  std::vector<geometry_msgs::msg::Pose> waypoints;
};
struct ArcPoint {
  std::string frame_id;
  geometry_msgs::msg::Pose via;
};
struct OwnMeaning {
  int frame_id = 0;
  geometry_msgs::msg::Pose pose;
};
struct StampedPose {
  std::string frame_id;
  geometry_msgs::msg::PoseStamped pose;
};

TEST(InBaseTest, AppliesToFieldsOfTheseNamesAndTypes)
{
  Poses goal{"table", std::vector<geometry_msgs::msg::Pose>(2)};
  for_each_pose(goal, [](geometry_msgs::msg::Pose & pose) { pose.position.x += 1.0; });
  EXPECT_EQ(goal.waypoints[1].position.x, 1.0);
  static_assert(GivenInFrame<Poses> && GivenInFrame<ArcPoint>);
  static_assert(!GivenInFrame<OwnMeaning> && !GivenInFrame<StampedPose>);
  StampedPose other;
  other.frame_id = "table";
  EXPECT_FALSE(GoalInBase(other).has_frame("base"));
}

using MoveL = ur_ros_rtde_msgs::action::MoveL::Goal;
constexpr Vector6 turned_base{0.0, 0.0, 0.5, 0.0, 0.0, half_turn};

MoveL move_l(double x, double orientation_z, double orientation_w)
{
  MoveL goal;
  goal.frame_id = "base_link";
  goal.pose.position.x = x;
  goal.pose.orientation.z = orientation_z;
  goal.pose.orientation.w = orientation_w;
  return goal;
}

TEST(GoalInBaseTest, NeedsNoFrameForPosesInBase)
{
  MoveL goal = move_l(0.5, 0.0, 1.0);
  EXPECT_TRUE(GoalInBase(goal).has_frame("base"));
  goal.frame_id = "";
  EXPECT_FALSE(GoalInBase(goal).has_frame("base"));
  goal.frame_id = "left_base";
  EXPECT_FALSE(GoalInBase(goal).has_frame("left_base"));
  EXPECT_TRUE(GoalInBase(goal).has_frame("base"));
  const int no_message = 0;
  EXPECT_FALSE(GoalInBase(no_message).has_frame("base"));
}

TEST(GoalInBaseTest, APositionAloneStillKeepsTheOrientation)
{
  const MoveL goal = move_l(0.5, 0.0, 1.0);
  GoalInBase in_base(goal);
  in_base.transform(turned_base);
  EXPECT_NEAR((*in_base).pose.position.x, -0.5, 1e-12);
  EXPECT_NEAR((*in_base).pose.position.z, 0.5, 1e-12);
  EXPECT_TRUE(has_identity_orientation((*in_base).pose));
  EXPECT_FALSE((*in_base).identity_orientation);
}

/// The orientation (0, 0, 1, 0) in base_link is that of `base`, and was asked for.
TEST(GoalInBaseTest, AnOrientationThatBecomesTheIdentityIsUsed)
{
  const MoveL goal = move_l(0.5, 1.0, 0.0);
  GoalInBase in_base(goal);
  in_base.transform(turned_base);
  EXPECT_NEAR(std::abs((*in_base).pose.orientation.w), 1.0, 1e-12);
  EXPECT_TRUE((*in_base).identity_orientation);
}

TEST(GoalInBaseTest, AnIdentityThatIsAskedForIsThatOfTheFrame)
{
  MoveL goal = move_l(0.5, 0.0, 1.0);
  goal.identity_orientation = true;
  GoalInBase in_base(goal);
  in_base.transform(turned_base);
  EXPECT_NEAR(std::abs((*in_base).pose.orientation.z), 1.0, 1e-12);
  EXPECT_TRUE((*in_base).identity_orientation);
}

}  // namespace
}  // namespace ur_ros_rtde
