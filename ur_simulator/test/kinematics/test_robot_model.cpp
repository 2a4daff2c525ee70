#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <set>

#include "support/random_vectors.hpp"

namespace ur_simulator {
namespace {

TEST(RobotModelTest, IncludesEveryArmOfCb3ESeriesAndUrSeries)
{
  std::set<std::string> names;
  for (const RobotModel & model : robot_models()) {
    names.insert(model.name);
  }
  const std::set<std::string> expected{"ur3",   "ur5",   "ur10",    "ur3e", "ur5e", "ur7e", "ur10e",
                                       "ur12e", "ur16e", "ur8long", "ur15", "ur18", "ur20", "ur30"};
  EXPECT_EQ(names, expected);
}

TEST(RobotModelTest, IsFoundByAnySpellingOfTheName)
{
  for (const char * name : {"ur8long", "UR8 Long", "UR8-LONG", "ur8_long"}) {
    const auto found = find_robot_model(name);
    ASSERT_TRUE(found) << name;
    EXPECT_EQ(found->get().name, "ur8long");
  }
}

TEST(RobotModelTest, ErrorForAnUnknownNameListsTheKnownOnes)
{
  const auto found = find_robot_model("ur11");
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().find("'ur11'"), std::string::npos);
  for (const RobotModel & model : robot_models()) {
    EXPECT_NE(found.error().find(model.name), std::string::npos) << model.name;
  }
}

TEST(RobotModelTest, ReachMatchesTheDataSheet)
{
  for (const RobotModel & model : robot_models()) {
    // The reach of the data sheets is measured to the wrist; the joint offsets add to it.
    const double stretched = -(model.a[1] + model.a[2]) + model.d[4];
    EXPECT_NEAR(stretched, model.reach, 0.09 * model.reach) << model.name;
  }
}

TEST(RobotModelTest, InertiasArePhysicallyConsistent)
{
  for (const RobotModel & model : robot_models()) {
    for (const Link & link : model.links) {
      EXPECT_GT(link.mass, 0.0) << model.name;
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(link.inertia);
      const Vector3 moments = principal.eigenvalues();
      EXPECT_GT(moments[0], 0.0) << model.name;
      // No principal moment of inertia exceeds the sum of the other two, up to the rounding of the published
      // values.
      EXPECT_LE(moments[2], 1.03 * (moments[0] + moments[1])) << model.name << " " << moments.transpose();
    }
  }
}

TEST(RobotModelTest, Cb3RunsAt125HzAndOthersAt500Hz)
{
  EXPECT_DOUBLE_EQ(testing::model_named("ur5").cycle_time(), 0.008);
  EXPECT_DOUBLE_EQ(testing::model_named("ur5e").cycle_time(), 0.002);
  EXPECT_DOUBLE_EQ(testing::model_named("ur20").cycle_time(), 0.002);
  EXPECT_FALSE(testing::model_named("ur5").has_force_torque_sensor());
  EXPECT_TRUE(testing::model_named("ur30").has_force_torque_sensor());
}

TEST(RobotModelTest, OnlyWrist3OfTheUr3IsContinuous)
{
  for (const RobotModel & model : robot_models()) {
    const bool small = model.name == "ur3" || model.name == "ur3e";
    EXPECT_EQ(std::isinf(model.position_max[5]), small) << model.name;
    EXPECT_TRUE(model.position_max.head<5>().allFinite()) << model.name;
  }
}

}  // namespace
}  // namespace ur_simulator
