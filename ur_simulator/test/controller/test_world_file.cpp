#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

/// Options with a world file of this text.
class WorldFileTest : public ::testing::Test {
 protected:
  ~WorldFileTest() override { std::filesystem::remove(path); }
  SimulatorOptions with_world(const std::string & text) const
  {
    std::ofstream(path) << text;
    SimulatorOptions options = with_unique_address();
    options.world_file = path.string();
    return options;
  }
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("cell_" + std::to_string(getpid()) + ".yaml");
};

TEST_F(WorldFileTest, PlacesItsObjects)
{
  SimulatedController controller(with_world(R"(surfaces: [{z: -0.2}]
boxes: [{center: [0.5, 0.1, 0.2], size: [0.1, 0.2, 0.4], rotation: [0, 0, 1]}]
springs: [{anchor: [0, 0, 1.5], stiffness: 10, length: 1}]
load: {mass: 2}
)"));
  const json state = controller.state();
  EXPECT_EQ(state["surfaces"][0]["point"][2], -0.2);
  EXPECT_EQ(state["boxes"][0], json::parse(R"({"id": 1, "center": [0.5, 0.1, 0.2], "size": [0.1, 0.2, 0.4],
                                               "rotation": [0.0, 0.0, 1.0]})"));
  EXPECT_EQ(state["springs"][0]["length"], 1.0);
  ASSERT_TRUE(wait_simulated_time(controller, 0.5, seconds(10)));
  EXPECT_NEAR(controller.state()["actual_tcp_force"][2].get<double>(), -19.6,
              5.0);  // the load, not configured
}

TEST_F(WorldFileTest, ExecutesEventsInTheCycleOfTheirTime)
{
  SimulatedController controller(with_world(R"(events:
  - {at: 0.2, command: protective_stop, reason: scripted}
  - {at: 0.1, command: set_digital_input, number: 3, value: true}
  - {at: 0.1, command: remove_box, id: 7}
)"));
  double input_time = 0.0;
  ASSERT_TRUE(controller.wait_until(
      [&](const json & state) {
        if (input_time == 0.0 && state["io"]["digital_inputs"] == 8) {
          input_time = state["timestamp"].get<double>();
        }
        return state["safety_mode"] == "PROTECTIVE_STOP";
      },
      seconds(10)));
  double first_time = 0.0;
  const json log = controller.control({{"command", "log"}});
  for (const json & entry : log["entries"]) {
    if (entry["text"].get<std::string>().find(":3: set_digital_input") != std::string::npos) {
      first_time = entry["timestamp"].get<double>();
    }
    if (entry["text"].get<std::string>().find(":2: protective_stop") != std::string::npos) {
      EXPECT_NEAR(entry["timestamp"].get<double>(), 0.2, 1e-9);
    }
  }
  EXPECT_NEAR(first_time, 0.1, 1e-9);
  EXPECT_GE(input_time, first_time - 1e-9);
  EXPECT_TRUE(log_contains(controller, ":4: remove_box: field 'id' is 7: there is no such object"));
}

TEST_F(WorldFileTest, TimeContinuesAfterReboot)
{
  SimulatedController controller(with_world(R"(events:
  - {at: 0.1, command: reboot, duration: 0.1}
  - {at: 0.4, command: set_digital_input, number: 0, value: true}
)"));
  ASSERT_TRUE(controller.wait_until([](const json & state) { return state["io"]["digital_inputs"] == 1; },
                                    seconds(10)));
  EXPECT_NEAR(controller.state()["timestamp"].get<double>(), 0.3, 0.1);  // since the reboot
  EXPECT_EQ(controller.state()["robot_mode"], "POWER_OFF");
}

TEST_F(WorldFileTest, InvalidFilesAreRejected)
{
  try {
    SimulatedController controller(with_world("surfaces: [{z: deep}]\n"));
    FAIL() << "accepted";
  } catch (const std::runtime_error & error) {
    EXPECT_EQ(std::string(error.what()), path.string() + ":1: field 'z' is \"deep\": it must be a number");
  }
  std::string surfaces = "surfaces:\n";
  for (int i = 0; i < 33; ++i) {
    surfaces += "- {z: -1}\n";
  }
  try {
    SimulatedController controller(with_world(surfaces));
    FAIL() << "accepted";
  } catch (const std::runtime_error & error) {
    EXPECT_EQ(std::string(error.what()),
              path.string() + ":34: place_surface: there are 32 objects of this kind already, the maximum");
  }
}

}  // namespace
}  // namespace ur_simulator::testing
