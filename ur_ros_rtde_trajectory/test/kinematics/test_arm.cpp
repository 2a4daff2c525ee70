#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "home.hpp"
#include "ur_ros_rtde_trajectory/arm.hpp"

namespace ur_ros_rtde::kinematics {
namespace {

Joints random_joints(std::mt19937 & random)
{
  std::uniform_real_distribution<double> between(-3.0, 3.0);
  Joints q;
  for (double & value : q) {
    value = between(random);
  }
  return q;
}

Pose tool()
{
  return to_pose({0.02, -0.03, 0.15, 0.1, 0.4, -0.2});
}

TEST(ArmTest, ForwardKinematicsMatchDhParameters)
{
  // Stretched out along -x at the height of the shoulder.
  const DhParameters ur5e{0.1625, -0.425, -0.3922, 0.1333, 0.0997, 0.0996};
  const Pose pose = Arm(ur5e).forward(Joints::Zero());
  EXPECT_NEAR(pose.translation().x(), -0.8172, 1e-12);
  EXPECT_NEAR(pose.translation().y(), -0.1333 - 0.0996, 1e-12);
  EXPECT_NEAR(pose.translation().z(), 0.1625 - 0.0997, 1e-12);
}

TEST(ArmTest, JacobianMatchesFiniteDifferences)
{
  std::mt19937 random(1);
  for (const DhParameters & lengths : nominal_dh_parameters()) {
    const Arm arm(lengths, tool());
    const Joints q = random_joints(random);
    const Jacobian jacobian = arm.jacobian(q);
    for (int j = 0; j < 6; ++j) {
      Joints before = q;
      Joints after = q;
      before[j] -= 1e-6;
      after[j] += 1e-6;
      const Twist column = difference(arm.forward(before), arm.forward(after)) / 2e-6;
      EXPECT_LT((column - jacobian.col(j)).norm(), 1e-6);
    }
  }
}

TEST(ArmTest, InverseKinematicsRecoverTheJointPositions)
{
  std::mt19937 random(2);
  int found = 0;
  for (int round = 0; round < 500; ++round) {
    const Arm arm(nominal_dh_parameters()[static_cast<std::size_t>(round) % nominal_dh_parameters().size()],
                  tool());
    const Joints q = random_joints(random);
    if (std::abs(arm.jacobian(q).determinant()) < 5e-3) {
      continue;  // near a singularity there are other solutions as near
    }
    const auto back = arm.inverse(arm.forward(q), q + 0.02);
    ASSERT_TRUE(back) << q.transpose();
    EXPECT_LT((*back - q).abs().maxCoeff(), 1e-6);
    ++found;
  }
  EXPECT_GT(found, 200);
}

TEST(ArmTest, InverseKinematicsFailOutOfReach)
{
  const Arm arm(nominal_dh_parameters()[4]);
  Pose far = arm.forward(home());
  far.translation() *= 5.0;
  EXPECT_FALSE(arm.inverse(far, home()));
}

TEST(IdentifyArmTest, FindsEveryModelByItsTcpPose)
{
  for (const DhParameters & lengths : nominal_dh_parameters()) {
    const Arm arm(lengths, tool());
    const auto identified = identify_arm(home(), arm.forward(home()), tool());
    ASSERT_TRUE(identified) << identified.error().message;
    EXPECT_LT(difference(identified->forward(home() + 0.3), arm.forward(home() + 0.3)).norm(), 1e-9);
  }
}

TEST(IdentifyArmTest, ToleratesCalibration)
{
  const DhParameters calibrated{0.1809, -0.6121, -0.5722, 0.1738, 0.1201, 0.1164};
  const auto identified = identify_arm(home(), Arm(calibrated, tool()).forward(home()), tool());
  ASSERT_TRUE(identified);
  const Arm published(DhParameters{0.1807, -0.6127, -0.57155, 0.17415, 0.11985, 0.11655}, tool());
  EXPECT_LT(difference(identified->forward(home()), published.forward(home())).norm(), 1e-9);
}

TEST(IdentifyArmTest, PrefersTheCalibrationOfTheArm)
{
  DhRows calibration = dh_rows(nominal_dh_parameters()[5]);
  calibration[1].theta = 0.0012;
  calibration[2].alpha = -0.0007;
  calibration[4].a = 0.0004;
  const Arm calibrated(calibration, tool());
  const auto identified = identify_arm(home(), calibrated.forward(home()), tool(), calibration);
  ASSERT_TRUE(identified);
  EXPECT_LT(difference(identified->forward(home() + 0.3), calibrated.forward(home() + 0.3)).norm(), 1e-12);
}

TEST(IdentifyArmTest, IgnoresTheCalibrationOfAnotherArm)
{
  const Arm ur5e(nominal_dh_parameters()[4], tool());
  const auto identified =
      identify_arm(home(), ur5e.forward(home()), tool(), dh_rows(nominal_dh_parameters()[5]));
  ASSERT_TRUE(identified);
  EXPECT_LT(difference(identified->forward(home() + 0.3), ur5e.forward(home() + 0.3)).norm(), 1e-12);
}

TEST(IdentifyArmTest, RejectsUnknownModel)
{
  const DhParameters stranger{0.3, -0.5, -0.45, 0.2, 0.1, 0.1};
  const auto rejected = identify_arm(home(), Arm(stranger).forward(home()), Pose::Identity());
  ASSERT_FALSE(rejected);
  EXPECT_EQ(rejected.error().code, ErrorCode::not_supported);
  EXPECT_NE(rejected.error().message.find("mm"), std::string::npos);
}

TEST(PoseTest, ConvertsToRotationVectorAndBack)
{
  const Vector6 pose{0.3, -0.2, 0.5, 1.2, -0.8, 2.1};
  const Vector6 back = to_ur(to_pose(pose));
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(back[i], pose[i], 1e-12);
  }
}

}  // namespace
}  // namespace ur_ros_rtde::kinematics
