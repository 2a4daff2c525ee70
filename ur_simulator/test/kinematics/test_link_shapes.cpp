#include <gtest/gtest.h>

#include "kinematics/forward_kinematics.hpp"
#include "kinematics/link_shapes.hpp"
#include "support/random_vectors.hpp"

namespace ur_simulator {
namespace {

std::vector<Capsule> capsules_at(const RobotModel & model, const Vector6 & joints)
{
  std::vector<Capsule> capsules = link_capsules(model);
  const auto frames = link_frames(model, joints);
  for (Capsule & capsule : capsules) {
    capsule = in_base_frame(capsule, frames);
  }
  return capsules;
}

double distance_of(const std::vector<Capsule> & capsules, Body first, Body second)
{
  double result = 10.0;
  for (const Capsule & a : capsules) {
    for (const Capsule & b : capsules) {
      if (a.body == first && b.body == second) {
        result = std::min(result, distance(a.axis, b.axis));
      }
    }
  }
  return result;
}

TEST(LinkShapesTest, EveryBodyHasCapsulesWithinItsCylinders)
{
  for (const RobotModel & model : robot_models()) {
    std::array<int, body_count> count{};
    const auto cylinders = link_cylinders(model);
    const auto capsules = link_capsules(model);
    ASSERT_EQ(cylinders.size(), capsules.size());
    for (std::size_t i = 0; i < capsules.size(); ++i) {
      ++count[static_cast<std::size_t>(capsules[i].body)];
      const double length = (cylinders[i].axis.end - cylinders[i].axis.begin).norm();
      const double shortened = (capsules[i].axis.end - capsules[i].axis.begin).norm();
      EXPECT_GT(capsules[i].radius, 0.01) << model.name;
      EXPECT_NEAR(shortened, cylinders[i].free_end ? std::max(0.0, length - capsules[i].radius) : length,
                  1e-12);
    }
    for (const int of_body : count) {
      EXPECT_GT(of_body, 0) << model.name;
    }
  }
}

TEST(LinkShapesTest, NeighborsStayConnectedInEveryPosition)
{
  testing::RandomVectors random(2);
  for (const RobotModel & model : robot_models()) {
    for (int i = 0; i < 20; ++i) {
      const auto capsules = capsules_at(model, random.six(3.0));
      for (std::size_t body = 1; body < body_count; ++body) {
        const double gap = distance_of(capsules, static_cast<Body>(body - 1), static_cast<Body>(body));
        EXPECT_LT(gap, 2.0 * model.joint_radius.minCoeff()) << model.name << " " << body;
      }
    }
  }
}

TEST(LinkShapesTest, TheWristReachesToTheFlange)
{
  for (const RobotModel & model : robot_models()) {
    const auto cylinders = link_cylinders(model);
    EXPECT_TRUE(cylinders.back().body == Body::wrist_3 && cylinders.back().axis.end.isZero(1e-12))
        << model.name;
  }
}

}  // namespace
}  // namespace ur_simulator
