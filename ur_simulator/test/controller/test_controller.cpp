#include <cmath>

#include "support/simulator_test.hpp"
#include "support/tcp_client.hpp"

namespace ur_simulator::testing {
namespace {

std::string construction_error(const SimulatorOptions & options)
{
  try {
    SimulatedController controller(options);
  } catch (const std::runtime_error & error) {
    return error.what();
  }
  return "no error";
}

TEST(ControllerTest, ReportsAddressAndPortInUse)
{
  const SimulatorOptions options = with_unique_address();
  SimulatedController first(options);
  const std::string message = construction_error(options);
  EXPECT_NE(message.find("port 30001 of " + options.address + " is in use"), std::string::npos) << message;
}

TEST(ControllerTest, RejectsInvalidOptionsWithReason)
{
  SimulatorOptions options = with_unique_address();
  options.model = "ur7000";
  EXPECT_NE(construction_error(options).find("ur10e"), std::string::npos) << construction_error(options);
  options = with_unique_address();
  options.polyscope_version = "new";
  EXPECT_NE(construction_error(options).find("'new'"), std::string::npos);
  options.polyscope_version = "3.15.8";
  EXPECT_NE(construction_error(options).find("ur10e does not run PolyScope 3.15.8"), std::string::npos);
  options = with_unique_address();
  options.initial_joints = std::array<double, 6>{0.0, 0.0, 0.0, 0.0, 0.0, 1000.0};
  EXPECT_NE(construction_error(options).find("initial joint 5 is 1000"), std::string::npos);
  for (const double factor : {0.0, -1.0, 1001.0, std::nan("")}) {
    options = with_unique_address();
    options.real_time_factor = factor;
    EXPECT_NE(construction_error(options).find("give 0.01 to 1000"), std::string::npos) << factor;
    options = with_unique_address();
    options.recovery_time_factor = factor;
    EXPECT_NE(construction_error(options).find("(--recovery-time-factor)"), std::string::npos) << factor;
  }
  options = {};
  options.address = "not an address";
  EXPECT_NE(construction_error(options).find("'not an address'"), std::string::npos);
  options.address = "192.0.2.1";
  EXPECT_NE(construction_error(options).find("no network interface"), std::string::npos)
      << construction_error(options);
}

TEST(ControllerTest, AppliesRecoveryTimeFactor)
{
  SimulatorOptions options = with_unique_address();
  options.recovery_time_factor = 0.02;
  SimulatedController controller(options);
  controller.control({{"command", "protective_stop"}, {"reason", "a test"}});
  ASSERT_TRUE(controller.wait_until(
      [](const json & state) { return state["safety_mode"] == "PROTECTIVE_STOP"; }, seconds(5)));
  const auto begin = std::chrono::steady_clock::now();
  while (!controller.control({{"command", "unlock_protective_stop"}})["ok"].get<bool>()) {
    ASSERT_LT(std::chrono::steady_clock::now() - begin, seconds(3)) << "0.02 of 5 s, and reserve";
    std::this_thread::sleep_for(milliseconds(5));
  }
}

TEST(ControllerTest, AppliesRealTimeFactor)
{
  SimulatorOptions options = with_unique_address();
  options.real_time_factor = 0.25;
  const auto begin = std::chrono::steady_clock::now();
  SimulatedController controller(options);
  ASSERT_TRUE(controller.wait_until(
      [](const json & state) { return state["timestamp"].get<double>() >= 0.1; }, seconds(5)));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(400));
}

TEST(ControllerTest, SelectsFreePorts)
{
  SimulatorOptions options = with_unique_address();
  options.ports = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  SimulatedController first(options);
  SimulatedController second(options);
  EXPECT_NE(first.ports().rtde, 0);
  EXPECT_NE(first.ports().rtde, second.ports().rtde);
}

TEST(ControllerTest, StartsPoweredOffIfConfigured)
{
  SimulatorOptions options = with_unique_address();
  options.start_running = false;
  SimulatedController controller(options);
  EXPECT_TRUE(wait_for_robot_mode(controller, "POWER_OFF", seconds(5)));
}

TEST(ControllerTest, StartsEveryModelWithToolPointingDown)
{
  for (const char * model :
       {"ur3", "ur5", "ur10", "ur3e", "ur5e", "ur7e", "ur10e", "ur12e", "ur15", "ur16e", "ur20", "ur30"}) {
    SimulatorOptions options = with_unique_address();
    options.model = model;
    SimulatedController controller(options);
    ASSERT_TRUE(wait_for_robot_mode(controller, "RUNNING", seconds(5)));
    const json pose = controller.state()["actual_tcp_pose"];
    EXPECT_GT(pose[2].get<double>(), 0.1) << model << pose.dump();
    // Pointing down: half a turn about a horizontal axis.
    EXPECT_NEAR(std::hypot(pose[3].get<double>(), pose[4].get<double>()), 3.14159, 0.01)
        << model << pose.dump();
    EXPECT_NEAR(pose[5].get<double>(), 0.0, 0.01) << model;
  }
}

TEST(ControllerTest, TimestampIsMultipleOfCycleTime)
{
  SimulatedController controller(with_unique_address());
  const json first = controller.state();
  ASSERT_TRUE(controller.wait_until(
      [&](const json & state) { return state["cycle"].get<int>() >= first["cycle"].get<int>() + 100; },
      seconds(10)));
  const json second = controller.state();
  const int cycles = second["cycle"].get<int>() - first["cycle"].get<int>();
  EXPECT_NEAR(second["timestamp"].get<double>() - first["timestamp"].get<double>(), 0.002 * cycles, 1e-9);
}

TEST(ControllerTest, WaitUntilTimesOutAndRethrowsExceptions)
{
  SimulatedController controller(with_unique_address());
  EXPECT_FALSE(controller.wait_until([](const json &) { return false; }, milliseconds(50)));
  EXPECT_THROW(
      controller.wait_until([](const json & state) { return state.at("no such thing") == 1; }, seconds(5)),
      nlohmann::json::out_of_range);
}

TEST(ControllerTest, StopsWithConnectedClientsAndRunningProgram)
{
  std::optional<SimulatedController> controller(std::in_place, with_unique_address());
  TcpClient script(controller->address(), 30002);
  script.send("def mine():\n  while True:\n    sync()\n  end\nend\n");
  ASSERT_TRUE(wait_for_program_state(*controller, "PLAYING"));
  controller.reset();
  EXPECT_TRUE(script.closed_by_peer());
}

}  // namespace
}  // namespace ur_simulator::testing
