#include <gtest/gtest.h>

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

Vector6 some_tool()
{
  Vector6 tool;
  tool << 0.02, -0.03, 0.15, 0.3, -0.2, 0.7;
  return tool;
}

TEST(ForwardKinematicsTest, StretchedUr10eReachesTheSumOfItsDhLengths)
{
  const RobotModel & model = model_named("ur10e");
  const Vector6 pose = tcp_pose(model, Vector6::Zero(), Vector6::Zero());
  EXPECT_NEAR(pose[0], -0.6127 - 0.57155, 1e-12);
  EXPECT_NEAR(pose[1], -0.17415 - 0.11655, 1e-12);
  EXPECT_NEAR(pose[2], 0.1807 - 0.11985, 1e-12);
  EXPECT_NEAR(pose[3], pi / 2.0, 1e-9);
}

TEST(ForwardKinematicsTest, UprightUr5eIsAboveItsBase)
{
  const RobotModel & model = model_named("ur5e");
  Vector6 joints;
  joints << 0.0, -pi / 2.0, 0.0, -pi / 2.0, 0.0, 0.0;
  const Vector6 pose = tcp_pose(model, joints, Vector6::Zero());
  EXPECT_NEAR(pose[0], 0.0, 1e-12);
  EXPECT_NEAR(pose[1], -0.1333 - 0.0996, 1e-12);
  EXPECT_NEAR(pose[2], 0.1625 + 0.425 + 0.3922 + 0.0997, 1e-12);
}

TEST(ForwardKinematicsTest, EqualsTheProductOfElementaryTransforms)
{
  RandomVectors random(1);
  for (const RobotModel & model : robot_models()) {
    const Vector6 joints = random.six(2.0 * pi);
    Transform product = Transform::Identity();
    for (Eigen::Index i = 0; i < 6; ++i) {
      product = product * Eigen::AngleAxisd(joints[i], Vector3::UnitZ()) *
                Eigen::Translation3d(model.a[i], 0.0, model.d[i]) *
                Eigen::AngleAxisd(model.alpha[i], Vector3::UnitX());
    }
    EXPECT_LT((product.matrix() - flange_pose(model, joints).matrix()).norm(), 1e-12) << model.name;
  }
}

TEST(ForwardKinematicsTest, DefaultPositionPointsTheToolDown)
{
  for (const RobotModel & model : robot_models()) {
    const Transform flange = flange_pose(model, default_position(model));
    EXPECT_NEAR(flange.linear()(2, 2), -1.0, 1e-5) << model.name;
    EXPECT_GT(flange.translation().z(), 0.1) << model.name;
    EXPECT_GT(singularity_distance(model, default_position(model)), 0.2) << model.name;
  }
}

TEST(JacobianTest, IsTheDerivativeOfThePose)
{
  RandomVectors random(2);
  constexpr double step = 1e-6;
  for (const RobotModel & model : robot_models()) {
    const Vector6 joints = random.six(pi);
    const Matrix6 jac = jacobian(model, joints, some_tool());
    for (Eigen::Index i = 0; i < 6; ++i) {
      const Transform previous =
          flange_pose(model, joints - step * Vector6::Unit(i)) * to_transform(some_tool());
      const Transform after =
          flange_pose(model, joints + step * Vector6::Unit(i)) * to_transform(some_tool());
      const Vector3 linear = (after.translation() - previous.translation()) / (2.0 * step);
      const Vector3 angular =
          to_rotation_vector(after.linear() * previous.linear().transpose()) / (2.0 * step);
      EXPECT_LT((linear - jac.col(i).head<3>()).norm(), 1e-7) << model.name << " joint " << i;
      EXPECT_LT((angular - jac.col(i).tail<3>()).norm(), 1e-7) << model.name << " joint " << i;
    }
  }
}

TEST(JacobianTest, TimeDerivativeMatchesFiniteDifferences)
{
  RandomVectors random(3);
  constexpr double step = 1e-6;
  for (const RobotModel & model : robot_models()) {
    const Vector6 joints = random.six(pi);
    const Vector6 velocity = random.six(2.0);
    const Matrix6 change = (jacobian(model, joints + step * velocity, some_tool()) -
                            jacobian(model, joints - step * velocity, some_tool())) /
                           (2.0 * step);
    const Matrix6 derivative = jacobian_time_derivative(model, joints, velocity, some_tool());
    EXPECT_LT((change - derivative).norm(), 1e-7) << model.name;
  }
}

}  // namespace
}  // namespace ur_simulator
