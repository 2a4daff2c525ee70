#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

SimulatorOptions gripper_options()
{
  SimulatorOptions options;
  options.urcaps = {"onrobot_soft_gripper"};
  return options;
}

class SoftGripperTest : public ::testing::Test {
 protected:
  SimulatedController controller{with_unique_address(gripper_options())};

  void run_script(const std::string & body)
  {
    const json reply =
        controller.control({{"command", "run_script"}, {"script", "def test():\n" + body + "\nend\n"}});
    ASSERT_TRUE(reply["ok"]) << reply.dump();
  }
  bool wait_for_program_end() { return wait_for_program_state(controller, "STOPPED"); }
  double width() { return controller.state()["gripper"]["width"]; }
  double output_register() { return controller.control({{"command", "registers"}})["outputs"]["doubles"][0]; }
};

TEST_F(SoftGripperTest, GripsToTargetWidth)
{
  const double before = controller.state()["timestamp"];
  run_script(" sg_grip(20, True, 0, True, False)\n write_output_float_register(0, get_sg_Width())");
  ASSERT_TRUE(wait_for_program_end());
  EXPECT_EQ(width(), 20.0);
  EXPECT_EQ(output_register(), 20.0);
  // 20 mm from 40 mm, at 20 mm/s.
  EXPECT_GT(controller.state()["timestamp"].get<double>() - before, 1.0);
}

TEST_F(SoftGripperTest, ReleasesFasterThanGentleGrip)
{
  const double before = controller.state()["timestamp"];
  run_script(" sg_release(70)");
  ASSERT_TRUE(wait_for_program_end());
  EXPECT_EQ(width(), 70.0);
  EXPECT_LT(controller.state()["timestamp"].get<double>() - before, 2.0);
}

TEST_F(SoftGripperTest, MovesWhileProgramContinues)
{
  run_script(
      " sg_grip(15, False, 0, False)\n write_output_float_register(0, get_sg_Width())\n while "
      "get_sg_Busy():\n  "
      "sync()\n end");
  ASSERT_TRUE(wait_for_program_end());
  EXPECT_GT(output_register(), 30.0);
  EXPECT_EQ(width(), 15.0);
}

TEST_F(SoftGripperTest, StopsAtObject)
{
  ASSERT_TRUE(controller.control({{"command", "gripper"}, {"object", 33.0}})["ok"]);
  run_script(" sg_grip(15, False)");
  ASSERT_TRUE(wait_for_program_end());
  EXPECT_EQ(width(), 33.0);
}

TEST_F(SoftGripperTest, HaltsTheProgramWithAPopupForAWidthOutOfRange)
{
  run_script(" sg_grip(200, False)");
  ASSERT_TRUE(wait_for_program_end());
  EXPECT_TRUE(log_contains(controller, "The Soft Gripper Grip command returned with error."));
  EXPECT_EQ(width(), 40.0);
}

TEST_F(SoftGripperTest, SticksUntilReleased)
{
  ASSERT_TRUE(controller.control({{"command", "gripper"}, {"stuck", true}})["ok"]);
  run_script(" sg_grip(15, False)");
  ASSERT_TRUE(wait_simulated_time(controller, 2.0, seconds(20)));
  EXPECT_EQ(controller.state()["program"]["state"], "PLAYING");
  EXPECT_TRUE(controller.state()["gripper"]["busy"]);
  ASSERT_TRUE(controller.control({{"command", "gripper"}, {"stuck", false}})["ok"]);
  EXPECT_TRUE(wait_for_program_end());
  EXPECT_EQ(width(), 15.0);
}

TEST(UrcapTest, GripperFunctionsAreUnknownWithoutUrcap)
{
  SimulatedController controller(with_unique_address());
  EXPECT_TRUE(controller.state()["gripper"].is_null());
  const json reply = controller.control({{"command", "run_script"}, {"script", "sg_grip(20)\n"}});
  EXPECT_FALSE(reply["ok"]);
  EXPECT_NE(controller.control({{"command", "gripper"}})["error"].get<std::string>().find("--urcap"),
            std::string::npos);
}

TEST(UrcapTest, RejectsUnknownUrcap)
{
  SimulatorOptions options;
  options.urcaps = {"coffee_machine"};
  EXPECT_THROW(SimulatedController controller(with_unique_address(options)), std::runtime_error);
}

}  // namespace
}  // namespace ur_simulator::testing
