#include <cmath>

#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

class CollisionTest : public SimulatorTest {
 protected:
  void move(const std::string & joints)
  {
    ASSERT_TRUE(
        controller.control({{"command", "run_script"},
                            {"script", "def program():\n  movej(" + joints + ", a=3, v=1)\nend\n"}})["ok"]);
  }
};

TEST_F(CollisionTest, OfTheArmWithItselfTriggersAProtectiveStop)
{
  move("[0, -1.57, -3.1, -1.57, 1.57, 0]");
  ASSERT_TRUE(wait_for_safety_mode(controller, "PROTECTIVE_STOP", seconds(20)));
  EXPECT_TRUE(wait_for_log(controller, "collision of the arm with itself"));
  EXPECT_TRUE(wait_until_at_rest(controller, seconds(5)));
  EXPECT_NE(controller.state()["safety_popup"].get<std::string>().find("collision of the arm with itself"),
            std::string::npos);
}

TEST_F(CollisionTest, WithABoxStopsTheArmWhichCanLeaveAfterwards)
{
  SimulatorOptions options = with_unique_address();
  options.recovery_time_factor = 0.02;
  SimulatedController cell(options);
  const json pose = cell.state()["actual_tcp_pose"];
  ASSERT_TRUE(cell.control({{"command", "place_box"},
                            {"center", {pose[0], pose[1].get<double>() - 0.45, pose[2].get<double>() + 0.12}},
                            {"size", {0.3, 0.3, 0.3}}})["ok"]);
  const auto turn_to = [&](const std::string & angle) {
    return cell.control({{"command", "run_script"},
                         {"script", "def program():\n  movej([" + angle +
                                        ", -1.57, 1.57, -1.57, -1.57, 0], a=3, v=1)\nend\n"}})["ok"] == true;
  };
  ASSERT_TRUE(turn_to("1.5"));
  ASSERT_TRUE(wait_for_safety_mode(cell, "PROTECTIVE_STOP", seconds(20)));
  EXPECT_TRUE(log_contains(cell, "touches box 1: collision"));
  ASSERT_TRUE(wait_until_at_rest(cell, seconds(5)));
  ASSERT_TRUE(wait_simulated_time(cell, 0.2, seconds(5)));
  ASSERT_TRUE(cell.control({{"command", "unlock_protective_stop"}})["ok"]);
  ASSERT_TRUE(cell.control({{"command", "stop_program"}})["ok"]);
  ASSERT_TRUE(turn_to("0"));
  ASSERT_TRUE(cell.wait_until(
      [](const json & state) { return std::abs(state["actual"]["position"][0].get<double>()) < 1e-3; },
      seconds(20)));
  EXPECT_EQ(cell.state()["safety_mode"], "NORMAL");
}

TEST_F(CollisionTest, CanBeIgnored)
{
  SimulatorOptions options = with_unique_address();
  options.detect_collisions = false;
  SimulatedController ghost(options);
  ASSERT_TRUE(ghost.control(
      {{"command", "run_script"},
       {"script", "def program():\n  movej([0, -1.57, -3.1, -1.57, 1.57, 0], a=8, v=3)\nend\n"}})["ok"]);
  ASSERT_TRUE(ghost.wait_until(
      [](const json & state) { return std::abs(state["actual"]["position"][2].get<double>() + 3.1) < 1e-3; },
      seconds(20)));
  EXPECT_EQ(ghost.state()["safety_mode"], "NORMAL");
}

TEST_F(CollisionTest, SetJointsPlacesTheArmWithoutACollision)
{
  ASSERT_TRUE(controller.control(
      {{"command", "set_joints"}, {"joints", {0.0, -1.57, -3.1, -1.57, 1.57, 0.0}}})["ok"]);
  ASSERT_TRUE(wait_simulated_time(controller, 0.1, seconds(5)));
  EXPECT_EQ(controller.state()["safety_mode"], "NORMAL");
}

}  // namespace
}  // namespace ur_simulator::testing
