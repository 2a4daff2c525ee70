#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "ur_ros_rtde_robot/state/conversions.hpp"
#include "ur_ros_rtde_trajectory/arm_limits.hpp"

namespace ur_ros_rtde {
namespace {

constexpr double pi = std::numbers::pi;

Quaternion from(const Eigen::Quaterniond & q)
{
  return {q.x(), q.y(), q.z(), q.w()};
}
Eigen::Quaterniond to_eigen(const Quaternion & q)
{
  return {q.w, q.x, q.y, q.z};
}
Eigen::Vector3d to_eigen(const Vector3 & v)
{
  return {v[0], v[1], v[2]};
}

class RotationConversionTest : public testing::TestWithParam<double> {};

TEST_P(RotationConversionTest, SurvivesTheRoundTripToARotationVector)
{
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d axis = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    const Eigen::Vector3d expected = GetParam() * axis;
    const auto found = rotation_vector(from(Eigen::Quaterniond(Eigen::AngleAxisd(GetParam(), axis))));
    ASSERT_TRUE(found);
    EXPECT_NEAR((to_eigen(*found) - expected).norm(), 0.0, 4e-16 + 1e-15 * GetParam())
        << "angle " << GetParam();
    EXPECT_NEAR(
        to_eigen(quaternion(*found)).angularDistance(Eigen::Quaterniond(Eigen::AngleAxisd(GetParam(), axis))),
        0.0, 1e-7);
  }
}

INSTANTIATE_TEST_SUITE_P(Angles, RotationConversionTest,
                         testing::Values(0.0, 1e-300, 1e-16, 1e-12, 1e-9, 1e-8, 1e-4, 0.3, 1.0, pi / 2, 3.0,
                                         pi - 1e-6, pi - 1e-9, pi - 1e-12));

TEST(RotationVectorTest, IsAtMostHalfATurnForEitherSignOfTheQuaternion)
{
  const Quaternion q{0.1, -0.2, 0.3, -0.9};
  const auto a = rotation_vector(q);
  const auto b = rotation_vector({-q.x, -q.y, -q.z, -q.w});
  ASSERT_TRUE(a && b);
  EXPECT_LE(to_eigen(*a).norm(), pi);
  EXPECT_NEAR((to_eigen(*a) - to_eigen(*b)).norm(), 0.0, 1e-15);
}

TEST(RotationVectorTest, AcceptsQuaternionsOfAnyNorm)
{
  const auto unit = rotation_vector({0.0, 0.0, std::sin(0.25), std::cos(0.25)});
  const auto scaled = rotation_vector({0.0, 0.0, 7.0 * std::sin(0.25), 7.0 * std::cos(0.25)});
  ASSERT_TRUE(unit && scaled);
  EXPECT_NEAR((*unit)[2], 0.5, 1e-15);
  EXPECT_NEAR((*scaled)[2], 0.5, 1e-15);
}

TEST(RotationVectorTest, RejectsAZeroQuaternionWithTheRemedy)
{
  const auto found = rotation_vector({0.0, 0.0, 0.0, 0.0});
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::invalid_goal);
  EXPECT_NE(found.error().message.find("w = 1"), std::string::npos);
}

TEST(RotationVectorTest, RejectsNonFiniteValues)
{
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(rotation_vector({bad, 0.0, 0.0, 1.0}));
    EXPECT_FALSE(rotation_vector({0.0, 0.0, 0.0, bad}));
  }
}

TEST(PoseTransTest, AgreesWithMatrixProducts)
{
  std::mt19937 random(2);
  std::uniform_real_distribution<double> number(-1.5, 1.5);
  const auto pose = [&] {
    return Vector6{number(random), number(random), number(random),
                   number(random), number(random), number(random)};
  };
  const auto matrix = [](const Vector6 & p) {
    const Eigen::Vector3d r(p[3], p[4], p[5]);
    Eigen::Isometry3d result =
        Eigen::Translation3d(p[0], p[1], p[2]) * Eigen::AngleAxisd(r.norm(), r.normalized());
    return result;
  };
  for (int i = 0; i < 100; ++i) {
    const auto a = pose();
    const auto b = pose();
    EXPECT_TRUE(matrix(pose_trans(a, b)).isApprox(matrix(a) * matrix(b), 1e-12));
    EXPECT_TRUE(matrix(pose_inverse(a)).isApprox(matrix(a).inverse(), 1e-12));
  }
}

TEST(TcpFrameForceTest, RotatesTheForceFromTheBaseToTheTcpFrame)
{
  Sample sample{};
  sample.actual_tcp_pose = {0.3, 0.1, 0.2, pi, 0.0, 0.0};  // the tool points down
  sample.actual_tcp_force = {1.0, 2.0, 20.0, 0.1, 0.2, 0.3};
  const auto wrench = tcp_frame_force(sample);
  const Vector6 expected{1.0, -2.0, -20.0, 0.1, -0.2, -0.3};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(wrench[i], expected[i], 1e-12);
  }
}

TEST(AtTcpTest, MovesTheTorqueFromTheFlange)
{
  // The tool points down, the TCP is 0.2 m in front of the flange, and 10 N push it along y of the base.
  const Vector6 tcp{0.3, 0.1, 0.2, pi, 0.0, 0.0};
  const Vector6 offset{0.0, 0.0, 0.2, 0.0, 0.0, 0.7};
  const Vector6 at_flange{0.0, 10.0, 0.0, 2.0, 0.0, 0.0};  // (0, 0, -0.2) x (0, 10, 0)
  const Vector6 wrench = at_tcp(at_flange, tcp, offset);
  const Vector6 expected{0.0, 10.0, 0.0, 0.0, 0.0, 0.0};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(wrench[i], expected[i], 1e-12);
  }
}

TEST(ArmLimitsTest, AreFoundInAnySpellingAndOnlyForKnownModels)
{
  ASSERT_TRUE(arm_limits("UR10e"));
  EXPECT_DOUBLE_EQ(arm_limits("ur10e")->velocity[0], 2.0 * pi / 3.0);
  EXPECT_FALSE(arm_limits("ur99"));
  EXPECT_GE(widest_arm_limits().velocity[0], arm_limits("ur3e")->velocity[5] - 1e-12);
}

}  // namespace
}  // namespace ur_ros_rtde
