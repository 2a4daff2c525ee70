#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "support/robot_fixture.hpp"
#include "world/contact_forces.hpp"

namespace ur_simulator {
namespace {

using std::numbers::pi;

/// State with the TCP at a position, of an arm without elasticity.
ControllerState tcp_at(const Vector3 & position, const Vector3 & velocity = Vector3::Zero())
{
  ControllerState state;
  state.actual_tcp_pose.head<3>() = position;
  state.actual_tcp_speed.head<3>() = velocity;
  return state;
}

Box unit_box()
{
  Box box;
  box.center = {1.0, 0.0, 0.5};
  return box;
}

TEST(BoxTest, PushesBackThroughTheNearestFace)
{
  EXPECT_EQ(contact_force(unit_box(), tcp_at({1.0, 0.0, 0.999})).cast<float>(),
            Vector3(0.0, 0.0, 20.0).cast<float>());
  EXPECT_NEAR(contact_force(unit_box(), tcp_at({0.502, 0.1, 0.5})).x(), -40.0, 1e-9);
  EXPECT_NEAR(contact_force(unit_box(), tcp_at({1.0, -0.4995, 0.3})).y(), -10.0, 1e-9);
}

TEST(BoxTest, HasNoEffectOutside)
{
  for (const Vector3 & position :
       {Vector3(1.0, 0.0, 1.001), Vector3(0.499, 0.0, 0.5), Vector3(1.6, 0.0, 0.999)}) {
    EXPECT_TRUE(contact_force(unit_box(), tcp_at(position)).isZero(0.0)) << position.transpose();
  }
}

TEST(BoxTest, IsTurnedByItsRotation)
{
  Box box = unit_box();
  box.rotation = {0.0, 0.0, pi / 4.0};
  const Vector3 force =
      contact_force(box, tcp_at(Vector3(1.0, 0.0, 0.5) + 0.499 * Vector3(1.0, 1.0, 0.0).normalized()));
  EXPECT_NEAR((force - 20.0 * Vector3(1.0, 1.0, 0.0).normalized()).norm(), 0.0, 1e-6);
}

TEST(BoxTest, ActsLikeASurfaceOnItsTopFace)
{
  Surface top;
  top.point.z() = 1.0;
  top.elasticity = {5000.0, 20.0, 0.3};
  Box box = unit_box();
  box.elasticity = top.elasticity;
  const ControllerState state = tcp_at({1.1, 0.2, 0.997}, {0.1, 0.0, -0.02});
  EXPECT_NEAR((contact_force(box, state) - contact_force(top, state)).norm(), 0.0, 1e-9);
  EXPECT_LT(contact_force(box, state).x(), -1.0);  // friction
}

TEST(SpringTest, PullsBeyondItsLengthAndPushesBelowIt)
{
  Spring spring;
  spring.anchor = {0.0, 0.0, 1.0};
  spring.stiffness = 200.0;
  spring.length = 0.4;
  EXPECT_NEAR(contact_force(spring, tcp_at({0.0, 0.0, 0.5})).z(), 20.0, 1e-9);
  EXPECT_NEAR(contact_force(spring, tcp_at({0.0, 0.0, 0.7})).z(), -20.0, 1e-9);
  EXPECT_TRUE(contact_force(spring, tcp_at({0.0, 0.4, 1.0})).isZero(1e-9));
  EXPECT_TRUE(contact_force(spring, tcp_at(spring.anchor)).isZero(0.0));
}

TEST(SpringTest, DampsTheMotionAlongItself)
{
  Spring spring;
  spring.anchor = {0.0, 0.0, 1.0};
  spring.damping = 50.0;
  const Vector3 force = contact_force(spring, tcp_at({0.0, 0.0, 0.5}, {0.3, 0.0, -0.1}));
  EXPECT_NEAR((force - Vector3(0.0, 0.0, 5.0)).norm(), 0.0, 1e-9);
}

TEST(SpringTest, ActsOnTheTool)
{
  testing::RobotFixture fixture;
  Spring spring;
  spring.anchor = fixture.state.actual_tcp_pose.head<3>() + Vector3(0.0, 0.3, 0.0);
  spring.stiffness = 100.0;
  fixture.world.springs().add(spring);
  fixture.run(0.5);
  EXPECT_NEAR(fixture.state.actual_tcp_force[1], 30.0, 0.3);  // the elasticity of the arm is in series
}

TEST(ObjectsTest, ErrorNamesFieldAndLimit)
{
  World world(testing::model_named("ur10e"), 1);
  Box box;
  box.size.y() = 0.0;
  try {
    world.boxes().add(box);
    FAIL() << "accepted";
  } catch (const std::invalid_argument & error) {
    EXPECT_STREQ(error.what(), "box: size (m) must be in [0.001, 100], is 0");
  }
  Spring spring;
  spring.anchor.x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(world.springs().add(spring), std::invalid_argument);
  EXPECT_TRUE(world.boxes().empty() && world.springs().empty());
}

TEST(ObjectsTest, IdentifiersStayUnique)
{
  World world(testing::model_named("ur10e"), 1);
  const auto first = world.boxes().add({});
  ASSERT_TRUE(world.boxes().remove(first));
  EXPECT_FALSE(world.boxes().remove(first));
  EXPECT_NE(world.boxes().add({}), first);
}

}  // namespace
}  // namespace ur_simulator
