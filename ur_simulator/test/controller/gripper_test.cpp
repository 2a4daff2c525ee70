#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

SimulatorOptions with_gripper()
{
  SimulatorOptions options;
  options.urcaps = {"onrobot_soft_gripper"};
  return options;
}

class ASoftGripper : public ::testing::Test {
 protected:
  SimulatedController controller{on_own_address(with_gripper())};

  void run(const std::string & body)
  {
    const json reply =
        controller.control({{"command", "run_script"}, {"script", "def test():\n" + body + "\nend\n"}});
    ASSERT_TRUE(reply["ok"]) << reply.dump();
  }
  bool wait_for_end() { return wait_for_program(controller, "STOPPED"); }
  double width() { return controller.state()["gripper"]["width"]; }
  double answer() { return controller.control({{"command", "registers"}})["outputs"]["doubles"][0]; }
};

TEST_F(ASoftGripper, grips_to_the_width_it_is_told_in_finite_time)
{
  const double before = controller.state()["timestamp"];
  run(" sg_grip(20, True, 0, True, False)\n write_output_float_register(0, get_sg_Width())");
  ASSERT_TRUE(wait_for_end());
  EXPECT_EQ(width(), 20.0);
  EXPECT_EQ(answer(), 20.0);
  // From 40 mm at 20 mm/s.
  EXPECT_GT(controller.state()["timestamp"].get<double>() - before, 1.0);
}

TEST_F(ASoftGripper, releases_faster_than_it_grips_gently)
{
  const double before = controller.state()["timestamp"];
  run(" sg_release(70)");
  ASSERT_TRUE(wait_for_end());
  EXPECT_EQ(width(), 70.0);
  EXPECT_LT(controller.state()["timestamp"].get<double>() - before, 2.0);
}

TEST_F(ASoftGripper, goes_on_while_the_program_does_not_wait)
{
  run(" sg_grip(15, False, 0, False)\n write_output_float_register(0, get_sg_Width())\n while sg_busy():\n  "
      "sync()\n end");
  ASSERT_TRUE(wait_for_end());
  EXPECT_GT(answer(), 30.0);
  EXPECT_EQ(width(), 15.0);
}

TEST_F(ASoftGripper, stops_at_what_lies_between_its_cups)
{
  ASSERT_TRUE(controller.control({{"command", "gripper"}, {"object", 33.0}})["ok"]);
  run(" sg_grip(15)");
  ASSERT_TRUE(wait_for_end());
  EXPECT_EQ(width(), 33.0);
}

TEST_F(ASoftGripper, warns_of_a_width_it_does_not_have)
{
  run(" sg_grip(200)");
  ASSERT_TRUE(wait_for_end());
  EXPECT_TRUE(logged(controller, "valid range is: 11 - 75"));
  EXPECT_EQ(width(), 40.0);
}

TEST_F(ASoftGripper, hangs_on_demand_and_goes_on)
{
  ASSERT_TRUE(controller.control({{"command", "gripper"}, {"stuck", true}})["ok"]);
  run(" sg_grip(15)");
  const double since = controller.state()["timestamp"];
  ASSERT_TRUE(controller.wait_until(
      [&](const json & state) { return state["timestamp"].get<double>() > since + 2.0; }, seconds(20)));
  EXPECT_EQ(controller.state()["program"]["state"], "PLAYING");
  EXPECT_TRUE(controller.state()["gripper"]["busy"]);
  ASSERT_TRUE(controller.control({{"command", "gripper"}, {"stuck", false}})["ok"]);
  EXPECT_TRUE(wait_for_end());
  EXPECT_EQ(width(), 15.0);
}

TEST(WithoutAGripper, its_functions_are_unknown)
{
  SimulatedController controller(on_own_address());
  EXPECT_TRUE(controller.state()["gripper"].is_null());
  const json reply = controller.control({{"command", "run_script"}, {"script", "sg_grip(20)\n"}});
  EXPECT_FALSE(reply["ok"]);
  EXPECT_NE(controller.control({{"command", "gripper"}})["error"].get<std::string>().find("--urcap"),
            std::string::npos);
}

TEST(AnUnknownUrcap, is_refused)
{
  SimulatorOptions options;
  options.urcaps = {"coffee_machine"};
  EXPECT_THROW(SimulatedController controller(on_own_address(options)), std::runtime_error);
}

}  // namespace
}  // namespace ur_simulator::testing
