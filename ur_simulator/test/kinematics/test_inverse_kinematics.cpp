#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "common/pose.hpp"
#include "kinematics/forward_kinematics.hpp"
#include "kinematics/inverse_kinematics.hpp"
#include "support/random_vectors.hpp"

namespace ur_simulator {
namespace {

using std::numbers::pi;
using testing::model_named;
using testing::RandomVectors;

double pose_error(const RobotModel & model, const Vector6 & joints, const Transform & flange)
{
  return (flange_pose(model, joints).matrix() - flange.matrix()).norm();
}

double angle_distance(const Vector6 & a, const Vector6 & b)
{
  double distance = 0.0;
  for (Eigen::Index i = 0; i < 6; ++i) {
    distance = std::max(distance, std::abs(std::remainder(a[i] - b[i], 2.0 * pi)));
  }
  return distance;
}

TEST(InverseKinematicsTest, EverySolutionReachesThePoseAndOneIsTheOriginalPosition)
{
  RandomVectors random(4);
  for (const RobotModel & model : robot_models()) {
    for (int i = 0; i < 2000; ++i) {
      const Vector6 joints = random.six(pi);
      const Transform flange = flange_pose(model, joints);
      const InverseSolutions solutions = all_inverse_solutions(model, flange, joints);
      ASSERT_GE(solutions.count, 2u) << model.name << " " << joints.transpose();
      double nearest = 10.0;
      for (const Vector6 & solution : solutions) {
        ASSERT_LT(pose_error(model, solution, flange), 1e-9) << model.name << " " << joints.transpose();
        ASSERT_LE(solution.cwiseAbs().maxCoeff(), pi);
        nearest = std::min(nearest, angle_distance(solution, joints));
      }
      ASSERT_LT(nearest, 1e-5) << model.name << " " << joints.transpose();
    }
  }
}

TEST(InverseKinematicsTest, FindsEightDistinctSolutions)
{
  const RobotModel & model = model_named("ur10e");
  Vector6 joints;
  joints << 0.4, -1.4, 1.6, -0.9, 1.2, 0.3;
  const InverseSolutions solutions = all_inverse_solutions(model, flange_pose(model, joints), joints);
  ASSERT_EQ(solutions.count, 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT(angle_distance(solutions.joints[i], solutions.joints[j]), 0.01) << i << " and " << j;
    }
  }
}

TEST(InverseKinematicsTest, ReturnsTheSolutionNearestToTheSeedWithItsRevolutions)
{
  RandomVectors random(5);
  for (const RobotModel & model : robot_models()) {
    for (int i = 0; i < 500; ++i) {
      const Vector6 joints = random.six(0.98 * 2.0 * pi);
      if (singularity_distance(model, joints) < 0.05) {
        continue;
      }
      const auto solution =
          nearest_inverse_solution(model, flange_pose(model, joints), joints + random.six(0.01));
      ASSERT_TRUE(solution) << model.name;
      ASSERT_LT((*solution - joints).norm(), 1e-6) << model.name << " " << joints.transpose();
    }
  }
}

TEST(InverseKinematicsTest, KeepsJoint6OfTheSeedAtAWristSingularity)
{
  const RobotModel & model = model_named("ur5e");
  for (const double wrist_2 : {0.0, pi}) {
    Vector6 joints;
    joints << 0.3, -1.2, 1.5, -0.8, wrist_2, 0.4;
    Vector6 seed = joints;
    seed[5] = 1.1;
    const Transform flange = flange_pose(model, joints);
    const auto solution = nearest_inverse_solution(model, flange, seed);
    ASSERT_TRUE(solution);
    EXPECT_NEAR((*solution)[5], 1.1, 1e-9);
    EXPECT_LT(pose_error(model, *solution, flange), 1e-9);
  }
}

TEST(InverseKinematicsTest, ReachesTheFullyStretchedArm)
{
  for (const RobotModel & model : robot_models()) {
    Vector6 joints;
    joints << 0.5, -0.7, 0.0, -0.9, 1.0, 0.2;
    const auto solution = nearest_inverse_solution(model, flange_pose(model, joints), joints);
    ASSERT_TRUE(solution) << model.name;
    EXPECT_LT(pose_error(model, *solution, flange_pose(model, joints)), 1e-8) << model.name;
  }
}

TEST(InverseKinematicsTest, DistinguishesUnreachablePosesFromJointLimits)
{
  RobotModel model = model_named("ur5e");
  Transform far = Transform::Identity();
  far.translation() = Vector3(2.0, 0.0, 0.3);
  EXPECT_EQ(nearest_inverse_solution(model, far, Vector6::Zero()).error(), InverseError::unreachable);

  Vector6 joints;
  joints << 0.4, -1.4, 1.6, -0.9, 1.2, 0.3;
  model.position_min[3] = 3.0;
  model.position_max[3] = 3.1;
  EXPECT_EQ(nearest_inverse_solution(model, flange_pose(model, joints), joints).error(),
            InverseError::beyond_limits);
}

TEST(InverseKinematicsTest, StaysWithinLimitsForAnySeed)
{
  RandomVectors random(6);
  for (const RobotModel & model : robot_models()) {
    for (int i = 0; i < 200; ++i) {
      const Vector6 joints = random.six(pi);
      const Transform flange = flange_pose(model, joints);
      const auto solution = nearest_inverse_solution(model, flange, random.six(20.0));
      ASSERT_TRUE(solution) << model.name;
      ASSERT_TRUE((solution->array() <= model.position_max.array()).all());
      ASSERT_TRUE((solution->array() >= model.position_min.array()).all());
      ASSERT_LT(pose_error(model, *solution, flange), 1e-8);
    }
  }
}

TEST(InverseKinematicsTest, HandlesPosesOnTheBaseAxisAndInvalidInput)
{
  const RobotModel & model = model_named("ur10e");
  Transform at_axis = Transform::Identity();
  at_axis.translation() = Vector3(0.0, 0.0, 0.8);
  EXPECT_FALSE(nearest_inverse_solution(model, at_axis, Vector6::Zero()));
  Transform nonsense = at_axis;
  nonsense.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(nearest_inverse_solution(model, nonsense, Vector6::Zero()));
}

TEST(GetInverseKinTest, AppliesTheTcpOffset)
{
  const RobotModel & model = model_named("ur10e");
  Vector6 tool;
  tool << 0.01, 0.02, 0.2, 0.5, 0.0, 0.3;
  const Vector6 joints = default_position(model);
  const auto solution = get_inverse_kin(model, tcp_pose(model, joints, tool), joints, tool);
  ASSERT_TRUE(solution) << solution.error();
  EXPECT_LT((*solution - joints).norm(), 1e-8);
}

TEST(GetInverseKinTest, SolvesAPoseOutOfReachOnlyWithinTheTolerance)
{
  const RobotModel & model = model_named("ur5e");
  Vector6 joints;
  joints << 0.0, -0.4, 0.0, -0.9, 1.3, 0.0;  // elbow stretched
  Vector6 pose = tcp_pose(model, joints, Vector6::Zero());
  const Vector3 outwards = (pose.head<3>() - Vector3(0.0, 0.0, model.d[0])).normalized();
  pose.head<3>() += 0.002 * outwards;
  EXPECT_FALSE(get_inverse_kin(model, pose, joints, Vector6::Zero()));
  const auto solution = get_inverse_kin(model, pose, joints, Vector6::Zero(), 0.01);
  ASSERT_TRUE(solution);
  const Vector6 reached = tcp_pose(model, *solution, Vector6::Zero());
  EXPECT_LT((reached.head<3>() - pose.head<3>()).norm(), 0.004);
}

TEST(GetInverseKinTest, ErrorContainsThePoseAndTheReach)
{
  Vector6 pose = Vector6::Zero();
  pose[0] = 3.0;
  const auto solution = get_inverse_kin(model_named("ur10e"), pose, Vector6::Zero(), Vector6::Zero());
  ASSERT_FALSE(solution);
  EXPECT_NE(solution.error().find("3.0000"), std::string::npos) << solution.error();
  EXPECT_NE(solution.error().find("UR10e"), std::string::npos) << solution.error();
  pose[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(get_inverse_kin(model_named("ur10e"), pose, Vector6::Zero(), Vector6::Zero()));
}

TEST(SingularityDistanceTest, IsZeroAtEachKindOfSingularity)
{
  const RobotModel & model = model_named("ur10e");
  Vector6 joints;
  joints << 0.4, -1.4, 1.6, -0.9, 1.2, 0.3;
  EXPECT_GT(singularity_distance(model, joints), 0.1);
  Vector6 wrist = joints;
  wrist[4] = 0.0;
  EXPECT_LT(singularity_distance(model, wrist), 1e-9);
  Vector6 elbow = joints;
  elbow[2] = 0.0;
  EXPECT_LT(singularity_distance(model, elbow), 1e-9);
}

}  // namespace
}  // namespace ur_simulator
