#include <cmath>

#include "support/raw_socket.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

std::string message_of(const SimulatorOptions & options)
{
  try {
    SimulatedController controller(options);
  } catch (const std::runtime_error & error) {
    return error.what();
  }
  return "no error";
}

TEST(Controller, names_address_and_port_when_a_port_is_in_use)
{
  const SimulatorOptions options = on_own_address();
  SimulatedController first(options);
  const std::string message = message_of(options);
  EXPECT_NE(message.find("port 30001 of " + options.address + " is in use"), std::string::npos) << message;
}

TEST(Controller, explains_options_that_make_no_sense)
{
  SimulatorOptions options = on_own_address();
  options.model = "ur7000";
  EXPECT_NE(message_of(options).find("ur10e"), std::string::npos) << message_of(options);
  options = on_own_address();
  options.polyscope_version = "new";
  EXPECT_NE(message_of(options).find("'new'"), std::string::npos);
  options.polyscope_version = "3.15.8";
  EXPECT_NE(message_of(options).find("ur10e does not run PolyScope 3.15.8"), std::string::npos);
  options = on_own_address();
  options.initial_joints = std::array<double, 6>{0.0, 0.0, 0.0, 0.0, 0.0, 1000.0};
  EXPECT_NE(message_of(options).find("initial joint 5 is 1000"), std::string::npos);
  for (const double factor : {0.0, -1.0, 11.0, std::nan("")}) {
    options = on_own_address();
    options.real_time_factor = factor;
    EXPECT_NE(message_of(options).find("give 0.01 to 10"), std::string::npos) << factor;
    options = on_own_address();
    options.recovery_time_factor = factor;
    EXPECT_NE(message_of(options).find("(--recovery-time-factor)"), std::string::npos) << factor;
  }
  options = {};
  options.address = "not an address";
  EXPECT_NE(message_of(options).find("'not an address'"), std::string::npos);
  options.address = "192.0.2.1";
  EXPECT_NE(message_of(options).find("no network interface"), std::string::npos) << message_of(options);
}

TEST(Controller, UnlocksSoonerWithARecoveryTimeFactor)
{
  SimulatorOptions options = on_own_address();
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

TEST(Controller, has_time_pass_slower_than_the_hosts_when_asked)
{
  SimulatorOptions options = on_own_address();
  options.real_time_factor = 0.25;
  const auto begin = std::chrono::steady_clock::now();
  SimulatedController controller(options);
  ASSERT_TRUE(controller.wait_until(
      [](const json & state) { return state["timestamp"].get<double>() >= 0.1; }, seconds(5)));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(400));
}

TEST(Controller, takes_free_ports_when_asked)
{
  SimulatorOptions options = on_own_address();
  options.ports = {0, 0, 0, 0, 0, 0};
  SimulatedController first(options);
  SimulatedController second(options);
  EXPECT_NE(first.ports().rtde, 0);
  EXPECT_NE(first.ports().rtde, second.ports().rtde);
}

TEST(Controller, starts_powered_off_when_asked)
{
  SimulatorOptions options = on_own_address();
  options.start_running = false;
  SimulatedController controller(options);
  EXPECT_TRUE(controller.wait_until([](const json & state) { return state["robot_mode"] == "POWER_OFF"; },
                                    seconds(5)));
}

TEST(Controller, starts_every_model_with_the_tool_pointing_down_in_front_of_the_robot)
{
  for (const char * model :
       {"ur3", "ur5", "ur10", "ur3e", "ur5e", "ur7e", "ur10e", "ur12e", "ur15", "ur16e", "ur20", "ur30"}) {
    SimulatorOptions options = on_own_address();
    options.model = model;
    SimulatedController controller(options);
    ASSERT_TRUE(controller.wait_until([](const json & state) { return state["robot_mode"] == "RUNNING"; },
                                      seconds(5)));
    const json pose = controller.state()["actual_tcp_pose"];
    EXPECT_GT(pose[2].get<double>(), 0.1) << model << pose.dump();
    // Pointing down: half a turn about a horizontal axis.
    EXPECT_NEAR(std::hypot(pose[3].get<double>(), pose[4].get<double>()), 3.14159, 0.01)
        << model << pose.dump();
    EXPECT_NEAR(pose[5].get<double>(), 0.0, 0.01) << model;
  }
}

TEST(Controller, its_clock_follows_the_cycles)
{
  SimulatedController controller(on_own_address());
  const json first = controller.state();
  ASSERT_TRUE(controller.wait_until(
      [&](const json & state) { return state["cycle"].get<int>() >= first["cycle"].get<int>() + 100; },
      seconds(10)));
  const json second = controller.state();
  const int cycles = second["cycle"].get<int>() - first["cycle"].get<int>();
  EXPECT_NEAR(second["timestamp"].get<double>() - first["timestamp"].get<double>(), 0.002 * cycles, 1e-9);
}

TEST(Controller, a_condition_that_never_holds_ends_at_its_limit_and_one_that_throws_at_once)
{
  SimulatedController controller(on_own_address());
  EXPECT_FALSE(controller.wait_until([](const json &) { return false; }, milliseconds(50)));
  EXPECT_THROW(
      controller.wait_until([](const json & state) { return state.at("no such thing") == 1; }, seconds(5)),
      nlohmann::json::out_of_range);
}

TEST(Controller, ends_at_once_with_clients_connected_and_a_program_running)
{
  std::optional<SimulatedController> controller(std::in_place, on_own_address());
  RawSocket script(controller->address(), 30002);
  script.send("def mine():\n  while True:\n    sync()\n  end\nend\n");
  ASSERT_TRUE(wait_for_program(*controller, "PLAYING"));
  controller.reset();
  EXPECT_TRUE(script.closed_by_peer());
}

}  // namespace
}  // namespace ur_simulator::testing
