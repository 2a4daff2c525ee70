#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinematics/forward_kinematics.hpp"
#include "kinematics/inverse_kinematics.hpp"
#include "support/random_vectors.hpp"

namespace ur_simulator {
namespace {

using testing::model_named;
using testing::RandomVectors;

using std::numbers::pi;

TEST(CalibrationTest, DisplacesTheFlangeByAboutAMillimeter)
{
  RandomVectors random(1);
  for (const RobotModel & nominal : robot_models()) {
    double largest = 0.0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const RobotModel arm = with_random_calibration(nominal, seed);
      const Vector6 joints = random.six(pi);
      const Transform error = flange_pose(nominal, joints).inverse() * flange_pose(arm, joints);
      largest = std::max(largest, error.translation().norm());
      EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), 0.005) << nominal.name << " " << seed;
    }
    EXPECT_GT(largest, 0.0008) << nominal.name;
    EXPECT_LT(largest, 0.008) << nominal.name;
  }
}

TEST(CalibrationTest, DependsOnTheSeedOnly)
{
  const RobotModel & nominal = model_named("ur5e");
  EXPECT_EQ(with_random_calibration(nominal, 7).alpha, with_random_calibration(nominal, 7).alpha);
  EXPECT_NE(with_random_calibration(nominal, 7).alpha, with_random_calibration(nominal, 8).alpha);
  EXPECT_FALSE(nominal.calibrated);
}

TEST(CalibrationTest, InverseKinematicsAreExactNearTheSeedAndFarFromIt)
{
  RandomVectors random(2);
  for (const RobotModel & nominal : robot_models()) {
    const RobotModel arm = with_random_calibration(nominal, 11);
    for (int i = 0; i < 200; ++i) {
      const Vector6 joints = random.six(pi);
      if (singularity_distance(arm, joints) < 0.05) {
        continue;
      }
      const Transform flange = flange_pose(arm, joints);
      const auto near = nearest_inverse_solution(arm, flange, joints + random.six(0.01));
      ASSERT_TRUE(near) << arm.name << " " << joints.transpose();
      EXPECT_LT((*near - joints).norm(), 1e-8) << arm.name;
      const auto far = nearest_inverse_solution(arm, flange, random.six(pi));
      ASSERT_TRUE(far) << arm.name << " " << joints.transpose();
      EXPECT_LT((flange_pose(arm, *far).matrix() - flange.matrix()).norm(), 1e-9) << arm.name;
    }
  }
}

TEST(CalibrationTest, UnreachablePosesAreDistinguishedFromJointLimits)
{
  RobotModel arm = with_random_calibration(model_named("ur5e"), 3);
  Transform far = Transform::Identity();
  far.translation() = Vector3(2.0, 0.0, 0.3);
  EXPECT_EQ(nearest_inverse_solution(arm, far, Vector6::Zero()).error(), InverseError::unreachable);
  Vector6 joints;
  joints << 0.4, -1.4, 1.6, -0.9, 1.2, 0.3;
  arm.position_min[0] = 1.5;  // no solution for this pose has joint 1 in this range
  arm.position_max[0] = 2.0;
  EXPECT_EQ(nearest_inverse_solution(arm, flange_pose(arm, joints), joints).error(),
            InverseError::beyond_limits);
}

}  // namespace
}  // namespace ur_simulator
