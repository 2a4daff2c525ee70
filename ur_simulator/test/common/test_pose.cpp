#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "common/pose.hpp"

namespace ur_simulator {
namespace {

using std::numbers::pi;

TEST(PoseTest, RotationVectorRoundTripsThroughTheMatrix)
{
  const Vector3 axis = Vector3(1.0, -2.0, 0.5).normalized();
  for (const double angle : {0.0, 1e-12, 1e-9, 1e-4, 0.5, 1.0, 3.0, pi - 1e-4, pi - 1e-8}) {
    const Vector3 vector = angle * axis;
    EXPECT_LT((to_rotation_vector(to_rotation_matrix(vector)) - vector).norm(), 1e-7 * std::max(angle, 1e-6))
        << angle;
  }
}

TEST(PoseTest, HalfTurnRoundTripsUpToTheSignOfTheAxis)
{
  const Vector3 axis = Vector3(0.3, 0.4, -0.5).normalized();
  const Vector3 back = to_rotation_vector(to_rotation_matrix(pi * axis));
  EXPECT_NEAR(back.norm(), pi, 1e-9);
  EXPECT_NEAR(std::abs(back.normalized().dot(axis)), 1.0, 1e-12);
}

TEST(PoseTest, PoseTimesInverseIsIdentity)
{
  Vector6 pose;
  pose << 0.1, -0.2, 0.3, 1.0, 0.5, -2.0;
  EXPECT_LT(pose_trans(pose, pose_inv(pose)).norm(), 1e-12);
}

TEST(PoseTest, PoseTransAppliesTheSecondPoseInTheFrameOfTheFirst)
{
  Vector6 quarter_turn, ahead;
  quarter_turn << 1.0, 2.0, 3.0, 0.0, 0.0, pi / 2.0;
  ahead << 0.5, 0.0, 0.0, 0.0, 0.0, 0.0;
  const Vector6 result = pose_trans(quarter_turn, ahead);
  EXPECT_NEAR(result[0], 1.0, 1e-12);
  EXPECT_NEAR(result[1], 2.5, 1e-12);
}

TEST(PoseTest, InterpolationTakesTheShortestRotationAndMeetsBothEnds)
{
  Vector6 from = Vector6::Zero(), to = Vector6::Zero();
  from[5] = 3.0;
  to[5] = -3.0;
  to[0] = 1.0;
  EXPECT_LT((interpolate_pose(from, to, 0.0) - from).norm(), 1e-9);
  EXPECT_LT((interpolate_pose(from, to, 1.0) - to).norm(), 1e-9);
  const Vector6 middle = interpolate_pose(from, to, 0.5);
  EXPECT_NEAR(middle[0], 0.5, 1e-12);
  EXPECT_NEAR(middle.tail<3>().norm(), pi, 1e-9);
}

TEST(PoseTest, ShiftedWrenchIncludesTheMomentOfTheForce)
{
  Vector6 wrench = Vector6::Zero();
  wrench[2] = 10.0;
  const Vector6 shifted = shift_wrench(wrench, Vector3(0.5, 0.0, 0.0));
  EXPECT_NEAR(shifted[4], -5.0, 1e-12);
  EXPECT_NEAR(shifted[2], 10.0, 1e-12);
}

TEST(PoseTest, FiniteCheckFindsNanAndInfinity)
{
  Vector6 values = Vector6::Zero();
  EXPECT_TRUE(is_finite(values));
  values[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_finite(values));
  values[3] = -std::numeric_limits<double>::infinity();
  EXPECT_FALSE(is_finite(values));
}

}  // namespace
}  // namespace ur_simulator
