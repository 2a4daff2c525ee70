#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "home.hpp"
#include "kinematics/tcp_path.hpp"
#include "ur_ros_rtde_trajectory/arm_limits.hpp"
#include "ur_ros_rtde_trajectory/cartesian.hpp"

namespace ur_ros_rtde::kinematics {
namespace {

constexpr DhParameters ur10e{0.1807, -0.6127, -0.57155, 0.17415, 0.11985, 0.11655};

trajectory::Limits limits()
{
  trajectory::Limits result;
  result.position_min.setConstant(-6.29);
  result.position_max.setConstant(6.29);
  result.velocity.setConstant(2.0);
  result.acceleration.setConstant(trajectory::default_acceleration);
  result.jerk.setConstant(trajectory::default_jerk);
  return result;
}

/// Poses of the TCP, from the home position on, each displaced by a step.
std::vector<Pose> poses_along(const Arm & arm, const std::vector<Twist> & steps)
{
  std::vector<Pose> poses{arm.forward(home())};
  for (const Twist & step : steps) {
    poses.push_back(moved(poses.back(), step));
  }
  return poses;
}

Twist step(double x, double y, double z, double turn = 0.0)
{
  Twist result;
  result << x, y, z, 0.0, 0.0, turn;
  return result;
}

IkFunction ik_of(const Arm & arm)
{
  return [arm](const Pose & pose, const Joints & guess) -> Expected<Joints> {
    if (const auto q = arm.inverse(pose, guess)) {
      return *q;
    }
    return failure(ErrorCode::unreachable, "out of reach");
  };
}

double distance_to_line(const Pose & pose, const Pose & from, const Pose & to)
{
  const Eigen::Vector3d along = (to.translation() - from.translation()).normalized();
  const Eigen::Vector3d offset = pose.translation() - from.translation();
  return (offset - offset.dot(along) * along).norm();
}

/// Largest linear and rotation speed of the TCP, by finite differences.
std::pair<double, double> max_speeds(const Arm & arm, const trajectory::Trajectory & plan)
{
  constexpr double h = 1e-3;
  std::pair<double, double> top{0.0, 0.0};
  for (double t = 0.0; t + h < plan.duration(); t += h) {
    const Twist move =
        difference(arm.forward(plan.sample(t).position), arm.forward(plan.sample(t + h).position));
    top.first = std::max(top.first, move.head<3>().norm() / h);
    top.second = std::max(top.second, move.tail<3>().norm() / h);
  }
  return top;
}

TEST(CartesianPlanTest, FollowsStraightLineAtItsSpeed)
{
  const Arm arm(ur10e);
  const auto poses = poses_along(arm, {step(0.0, 0.0, -0.4)});
  const auto plan = plan_cartesian(poses, arm, home(), limits(), {.speed = 0.3}, ik_of(arm));
  ASSERT_TRUE(plan) << plan.error().message;
  ASSERT_TRUE(plan->verify(limits())) << plan->verify(limits()).error().message;
  for (double t = 0.0; t <= plan->duration(); t += 0.005) {
    EXPECT_LT(distance_to_line(arm.forward(plan->sample(t).position), poses[0], poses[1]), 1e-4);
  }
  EXPECT_LT(difference(arm.forward(plan->sample(plan->duration()).position), poses[1]).norm(), 1e-8);
  const auto [speed, turn] = max_speeds(arm, *plan);
  EXPECT_NEAR(speed, 0.3, 0.003);
  EXPECT_LT(turn, 0.02);
}

TEST(CartesianPlanTest, FollowsTheLineOfACalibratedArm)
{
  DhRows calibration = dh_rows(ur10e);
  calibration[0].alpha += 0.0011;
  calibration[1] = {-0.0009, ur10e.a2 + 0.0006, 0.0004, 0.0013};
  calibration[2] = {0.0014, ur10e.a3 - 0.0007, -0.0003, -0.0008};
  const Arm real(calibration);
  const auto poses = poses_along(real, {step(0.0, 0.3, -0.5)});
  const auto largest_deviation = [&](const Arm & known) {
    const auto plan = plan_cartesian(poses, known, home(), limits(), {}, ik_of(real));
    EXPECT_TRUE(plan) << plan.error().message;
    double result = 0.0;
    for (double t = 0.0; t <= plan->duration(); t += 0.005) {
      const Pose pose = real.forward(plan->sample(t).position);
      result = std::max(result, distance_to_line(pose, poses[0], poses[1]));
    }
    return result;
  };
  EXPECT_LT(largest_deviation(real), 5e-6);
  const double nominal = largest_deviation(Arm(ur10e));
  EXPECT_GT(nominal, 5e-5) << "the interpolated correction is not exact between the poses";
  EXPECT_LT(nominal, 1e-3);
}

TEST(CartesianPlanTest, KeepsJointLimitsAtExcessiveTcpSpeed)
{
  const Arm arm(ur10e);
  const auto poses = poses_along(arm, {step(0.0, 0.5, -0.3), step(-0.2, 0.0, 0.2)});
  const auto plan =
      plan_cartesian(poses, arm, home(), limits(), {.speed = 3.0, .rotation_speed = 6.0}, ik_of(arm));
  ASSERT_TRUE(plan) << plan.error().message;
  const auto use = plan->verify(limits());
  ASSERT_TRUE(use) << use.error().message;
  EXPECT_GT(std::max({use->velocity, use->acceleration, use->jerk}), 0.99);
}

TEST(CartesianPlanTest, KeepsTheRotationSpeed)
{
  const Arm arm(ur10e);
  const auto poses = poses_along(arm, {step(0.0, 0.0, 0.0, 1.0), step(0.02, 0.0, 0.0, -0.5)});
  const auto plan =
      plan_cartesian(poses, arm, home(), limits(), {.speed = 0.25, .rotation_speed = 0.4}, ik_of(arm));
  ASSERT_TRUE(plan) << plan.error().message;
  const auto [speed, turn] = max_speeds(arm, *plan);
  EXPECT_NEAR(turn, 0.4, 0.004);
  EXPECT_LT(speed, 0.25);
}

TEST(CartesianPlanTest, StopsAtCornersUnlessBlended)
{
  const Arm arm(ur10e);
  const auto poses = poses_along(arm, {step(0.0, 0.2, 0.0), step(0.0, 0.0, -0.2)});
  const auto through = plan_cartesian(poses, arm, home(), limits(), {.speed = 0.2}, ik_of(arm));
  const auto round =
      plan_cartesian(poses, arm, home(), limits(), {.speed = 0.2, .blend_radius = 0.03}, ik_of(arm));
  ASSERT_TRUE(through && round);
  EXPECT_LT(round->duration(), 0.9 * through->duration());
  const double corner = through->time_of_waypoint(1);
  EXPECT_LT(through->sample(corner).velocity.abs().maxCoeff(), 1e-3);
  double nearest = 1.0;
  for (double t = 0.0; t < round->duration(); t += 0.002) {
    const Pose here = arm.forward(round->sample(t).position);
    nearest = std::min(nearest, (here.translation() - poses[1].translation()).norm());
  }
  EXPECT_LT(nearest, 0.03 + 1e-4);
  EXPECT_GT(nearest, 0.02);
}

TEST(CartesianPlanTest, RepeatedPosesYieldZeroDuration)
{
  const Arm arm(ur10e);
  const auto poses = poses_along(arm, {step(0, 0, 0), step(0, 0, 0)});
  const auto plan = plan_cartesian(poses, arm, home(), limits(), {}, ik_of(arm));
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan->duration(), 0.0);
  EXPECT_EQ(plan->waypoint_count(), 3U);
}

// The first pose is often the current one, as measured.
TEST(CartesianPlanTest, FollowsSegmentsOfMicrometers)
{
  const Arm arm(ur10e);
  for (const double length : {0.2e-6, 2e-6, 12e-6}) {
    const auto poses = poses_along(arm, {step(length, 0.0, 0.0), step(0.0, 0.1, 0.0)});
    const auto plan = plan_cartesian(poses, arm, home(), limits(), {.speed = 0.2}, ik_of(arm));
    EXPECT_TRUE(plan) << length << ": " << (plan ? "" : plan.error().message);
  }
}

// The controller knows the calibration of the arm, the planner knows the nominal parameters.
TEST(CartesianPlanTest, ReachesThePosesOfCalibratedArm)
{
  const Arm real(DhParameters{0.1809, -0.6121, -0.5722, 0.1738, 0.1201, 0.1164});
  const Arm published(ur10e);
  const auto poses = poses_along(real, {step(0.0, 0.3, -0.2), step(-0.2, -0.2, -0.1, 0.5)});
  const auto plan = plan_cartesian(poses, published, home(), limits(), {}, ik_of(real));
  ASSERT_TRUE(plan) << plan.error().message;
  for (const std::size_t i : {0U, 1U, 2U}) {
    const Pose there = real.forward(plan->sample(plan->time_of_waypoint(i)).position);
    EXPECT_LT(difference(there, poses[i]).norm(), 1e-5) << "pose " << i;
  }
  for (double t = 0.0; t < plan->time_of_waypoint(1); t += 0.01) {
    EXPECT_LT(distance_to_line(real.forward(plan->sample(t).position), poses[0], poses[1]), 3e-4);
  }
}

TEST(CartesianPlanTest, RejectsNumbersThatAreNotFiniteOrOutOfRange)
{
  const Arm arm(ur10e);
  const auto poses = poses_along(arm, {step(0.0, 0.1, 0.0)});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto rejects = [&](const std::vector<Pose> & path, const Joints & start,
                           const CartesianOptions & options, const std::string & field) {
    const auto plan = plan_cartesian(path, arm, start, limits(), options, ik_of(arm));
    ASSERT_FALSE(plan) << field;
    EXPECT_EQ(plan.error().code, ErrorCode::invalid_goal);
    EXPECT_EQ(plan.error().message.find(field), 0U) << plan.error().message;
  };
  auto not_finite = poses;
  not_finite[1].translation().y() = nan;
  rejects({}, home(), {}, "poses is empty");
  rejects(not_finite, home(), {}, "poses[1]");
  rejects(poses, Joints::Constant(nan), {}, "start");
  rejects(poses, home(), {.speed = 0.0}, "speed is 0");
  rejects(poses, home(), {.rotation_speed = nan}, "rotation_speed is nan");
  rejects(poses, home(), {.blend_radius = -0.01}, "blend_radius is -0.01");
}

struct Obstruction {
  const char * name;
  Twist step;
  const char * message;
};

class UnreachablePathTest : public testing::TestWithParam<Obstruction> {};

TEST_P(UnreachablePathTest, IsRejectedWithTheReason)
{
  const Arm arm(ur10e);
  const auto poses = poses_along(arm, {step(0.0, 0.0, 0.01), GetParam().step});
  const auto plan = plan_cartesian(poses, arm, home(), limits(), {}, ik_of(arm));
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, ErrorCode::unreachable);
  EXPECT_NE(plan.error().message.find(GetParam().message), std::string::npos) << plan.error().message;
  EXPECT_NE(plan.error().message.find("poses[1]"), std::string::npos) << plan.error().message;
}

INSTANTIATE_TEST_SUITE_P(Each, UnreachablePathTest,
                         testing::Values(Obstruction{"ArmStretchedOut", step(-1.2, 0.0, 0.0), "elbow_joint"},
                                         Obstruction{"NearBaseAxis", step(0.7, 0.3, 0.0),
                                                     "shoulder_pan_joint"}),
                         [](const auto & hindrance) { return hindrance.param.name; });

TEST(TcpPathTest, IsContinuousInPositionAndDirectionAtCorners)
{
  const Arm arm(ur10e);
  const auto poses =
      poses_along(arm, {step(0.0, 0.2, 0.0, 0.4), step(0.0, 0.0, -0.2), step(0.1, -0.1, 0.0, -0.7)});
  const TcpPath path(poses, 0.02);
  constexpr double h = 1e-5;
  Twist last = difference(path.at(0.0), path.at(h)) / h;
  for (double u = h; u + h < path.length(); u += h) {
    const Twist rate = difference(path.at(u), path.at(u + h)) / h;
    ASSERT_LT((rate - last).norm(), 2e-3) << "at " << u;
    last = rate;
  }
  EXPECT_EQ(path.stops().size(), 2U);
  EXPECT_EQ(TcpPath(poses, 0.0).stops().size(), 4U);
}

}  // namespace
}  // namespace ur_ros_rtde::kinematics
