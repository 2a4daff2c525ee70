#include "robot_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

/// What ur_rtde does not wait for: the control program enters force mode after forceMode() has returned.
struct ForceModeTest : RobotFixture {
  bool enter(int type)
  {
    return control()->forceMode({0, 0, 0, 0, 0, 0}, {0, 0, 1, 0, 0, 0}, {0, 0, 0, 0, 0, 0}, type,
                                {0.1, 0.1, 0.01, 0.1, 0.1, 0.1});
  }
  bool is_executed() const { return robot->control_for_queries()->waitUntilLastCommandExecuted(); }
};

TEST_F(ForceModeTest, IsOnWhenItsCommandHasBeenExecuted)
{
  make_both();
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(enter(2));
    ASSERT_TRUE(is_executed());
    EXPECT_TRUE(controller.state()["force_mode"]) << "entered " << i << " times before";
    ASSERT_TRUE(control()->forceModeStop());
    EXPECT_TRUE(is_executed()) << "forceModeStop() has waited";
  }
}

TEST_F(ForceModeTest, TheEndOfTheProgramByARejectedArgumentIsReported)
{
  make_both();
  ASSERT_TRUE(enter(4)) << "only sent";
  EXPECT_FALSE(is_executed()) << "the type is 1 to 3";
  EXPECT_TRUE(becomes_ready_again());
}

}  // namespace
}  // namespace ur_ros_rtde::test
