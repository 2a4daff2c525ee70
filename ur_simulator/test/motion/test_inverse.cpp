#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "common/pose.hpp"
#include "kinematics/forward.hpp"
#include "kinematics/inverse.hpp"
#include "random_joints.hpp"

namespace ur_simulator {
namespace {

using std::numbers::pi;
using testing::model_named;
using testing::RandomVectors;

double pose_error(const RobotModel & model, const Vector6 & joints, const Transform & flange)
{
  return (forward_flange(model, joints).matrix() - flange.matrix()).norm();
}

double angle_distance(const Vector6 & a, const Vector6 & b)
{
  double distance = 0.0;
  for (Eigen::Index i = 0; i < 6; ++i) {
    distance = std::max(distance, std::abs(std::remainder(a[i] - b[i], 2.0 * pi)));
  }
  return distance;
}

TEST(InverseKinematics, every_solution_reaches_the_pose_and_one_is_the_posture_it_came_from)
{
  RandomVectors random(4);
  for (const RobotModel & model : robot_models()) {
    for (int i = 0; i < 2000; ++i) {
      const Vector6 joints = random.six(pi);
      const Transform flange = forward_flange(model, joints);
      const InverseSolutions solutions = inverse_all(model, flange, joints);
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

TEST(InverseKinematics, finds_eight_different_postures_where_there_are_eight)
{
  const RobotModel & model = model_named("ur10e");
  Vector6 joints;
  joints << 0.4, -1.4, 1.6, -0.9, 1.2, 0.3;
  const InverseSolutions solutions = inverse_all(model, forward_flange(model, joints), joints);
  ASSERT_EQ(solutions.count, 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT(angle_distance(solutions.joints[i], solutions.joints[j]), 0.01) << i << " and " << j;
    }
  }
}

TEST(InverseKinematics, gives_the_posture_nearest_to_the_seed_with_its_whole_turns)
{
  RandomVectors random(5);
  for (const RobotModel & model : robot_models()) {
    for (int i = 0; i < 500; ++i) {
      const Vector6 joints = random.six(0.98 * 2.0 * pi);
      if (dexterity(model, joints) < 0.05) {
        continue;
      }
      const auto solution = inverse_nearest(model, forward_flange(model, joints), joints + random.six(0.01));
      ASSERT_TRUE(solution) << model.name;
      ASSERT_LT((*solution - joints).norm(), 1e-6) << model.name << " " << joints.transpose();
    }
  }
}

TEST(InverseKinematics, keeps_joint_6_of_the_seed_where_the_wrist_is_singular)
{
  const RobotModel & model = model_named("ur5e");
  for (const double wrist_2 : {0.0, pi}) {
    Vector6 joints;
    joints << 0.3, -1.2, 1.5, -0.8, wrist_2, 0.4;
    Vector6 seed = joints;
    seed[5] = 1.1;
    const Transform flange = forward_flange(model, joints);
    const auto solution = inverse_nearest(model, flange, seed);
    ASSERT_TRUE(solution);
    EXPECT_NEAR((*solution)[5], 1.1, 1e-9);
    EXPECT_LT(pose_error(model, *solution, flange), 1e-9);
  }
}

TEST(InverseKinematics, reaches_the_fully_stretched_arm)
{
  for (const RobotModel & model : robot_models()) {
    Vector6 joints;
    joints << 0.5, -0.7, 0.0, -0.9, 1.0, 0.2;
    const auto solution = inverse_nearest(model, forward_flange(model, joints), joints);
    ASSERT_TRUE(solution) << model.name;
    EXPECT_LT(pose_error(model, *solution, forward_flange(model, joints)), 1e-8) << model.name;
  }
}

TEST(InverseKinematics, knows_out_of_reach_from_beyond_joint_limits)
{
  RobotModel model = model_named("ur5e");
  Transform far = Transform::Identity();
  far.translation() = Vector3(2.0, 0.0, 0.3);
  EXPECT_EQ(inverse_nearest(model, far, Vector6::Zero()).error(), InverseError::unreachable);

  Vector6 joints;
  joints << 0.4, -1.4, 1.6, -0.9, 1.2, 0.3;
  model.position_min[3] = 3.0;
  model.position_max[3] = 3.1;
  EXPECT_EQ(inverse_nearest(model, forward_flange(model, joints), joints).error(),
            InverseError::beyond_limits);
}

TEST(InverseKinematics, stays_within_limits_however_far_off_the_seed)
{
  RandomVectors random(6);
  for (const RobotModel & model : robot_models()) {
    for (int i = 0; i < 200; ++i) {
      const Vector6 joints = random.six(pi);
      const Transform flange = forward_flange(model, joints);
      const auto solution = inverse_nearest(model, flange, random.six(20.0));
      ASSERT_TRUE(solution) << model.name;
      ASSERT_TRUE((solution->array() <= model.position_max.array()).all());
      ASSERT_TRUE((solution->array() >= model.position_min.array()).all());
      ASSERT_LT(pose_error(model, *solution, flange), 1e-8);
    }
  }
}

TEST(InverseKinematics, survives_poses_at_the_base_axis_and_nonsense)
{
  const RobotModel & model = model_named("ur10e");
  Transform at_axis = Transform::Identity();
  at_axis.translation() = Vector3(0.0, 0.0, 0.8);
  EXPECT_FALSE(inverse_nearest(model, at_axis, Vector6::Zero()));
  Transform nonsense = at_axis;
  nonsense.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(inverse_nearest(model, nonsense, Vector6::Zero()));
}

TEST(GetInverseKin, takes_the_tool_into_account)
{
  const RobotModel & model = model_named("ur10e");
  Vector6 tool;
  tool << 0.01, 0.02, 0.2, 0.5, 0.0, 0.3;
  const Vector6 joints = default_position(model);
  const auto solution = get_inverse_kin(model, forward_tcp(model, joints, tool), joints, tool);
  ASSERT_TRUE(solution) << solution.error();
  EXPECT_LT((*solution - joints).norm(), 1e-8);
}

TEST(GetInverseKin, answers_a_pose_just_out_of_reach_within_its_tolerance_only)
{
  const RobotModel & model = model_named("ur5e");
  Vector6 joints;
  joints << 0.0, -0.4, 0.0, -0.9, 1.3, 0.0;  // elbow stretched
  Vector6 pose = forward_tcp(model, joints, Vector6::Zero());
  const Vector3 outwards = (pose.head<3>() - Vector3(0.0, 0.0, model.d[0])).normalized();
  pose.head<3>() += 0.002 * outwards;
  EXPECT_FALSE(get_inverse_kin(model, pose, joints, Vector6::Zero()));
  const auto solution = get_inverse_kin(model, pose, joints, Vector6::Zero(), 0.01);
  ASSERT_TRUE(solution);
  const Vector6 reached = forward_tcp(model, *solution, Vector6::Zero());
  EXPECT_LT((reached.head<3>() - pose.head<3>()).norm(), 0.004);
}

TEST(GetInverseKin, names_the_pose_and_the_reach_when_it_refuses)
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

TEST(Dexterity, is_zero_at_each_kind_of_singularity)
{
  const RobotModel & model = model_named("ur10e");
  Vector6 joints;
  joints << 0.4, -1.4, 1.6, -0.9, 1.2, 0.3;
  EXPECT_GT(dexterity(model, joints), 0.1);
  Vector6 wrist = joints;
  wrist[4] = 0.0;
  EXPECT_LT(dexterity(model, wrist), 1e-9);
  Vector6 elbow = joints;
  elbow[2] = 0.0;
  EXPECT_LT(dexterity(model, elbow), 1e-9);
}

}  // namespace
}  // namespace ur_simulator
