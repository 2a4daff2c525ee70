#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "rtde/fields.hpp"
#include "support/rtde_client.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

constexpr double first_event = 0.5;  // s; the client is connected by then
constexpr double end = 3.0;          // s

/// Contact, pushes, programs with motions in force mode and random numbers, a protective stop.
constexpr const char * scenario = R"(boxes:
  - {center: [-0.69, -0.17, 0.3], size: [0.5, 0.5, 0.6], friction: 0.2}
springs:
  - {anchor: [-0.5, 0.3, 1.2], stiffness: 30, length: 0.4}
load: {mass: 0.7}
events:
  - at: 0.5
    command: run_script
    script: |
      def program():
        movel(pose_add(get_actual_tcp_pose(), p[0, 0.05 * random(), 0.03, 0, 0, 0]), a=1.2, v=0.25)
        force_mode(p[0, 0, 0, 0, 0, 0], [0, 0, 1, 0, 0, 0], [0, 0, -10, 0, 0, 0], 2, [0.1, 0.1, 0.05, 1, 1, 1])
        sleep(0.4)
        end_force_mode()
        while True:
          write_output_float_register(0, get_tcp_force()[2])
          speedj([0.2, 0, 0, 0, 0.1, 0], 2.0, 0.01)
        end
      end
  - {at: 0.7, command: push, force: [20, 10, 0], duration: 0.2}
  - {at: 1.0, command: set_analog_input, number: 0, value: 3.3}
  - {at: 1.8, command: protective_stop}
  - {at: 2.5, command: unlock_protective_stop}
  - {at: 2.6, command: run_script, script: "def program():\n  movej([0, -1.4, -1.6, -1.6, 1.6, 0.1])\nend\n"}
)";

/// Names of all outputs, the time first. The computation time of a cycle is the only output that is measured.
std::string output_names(const PolyscopeVersion & version)
{
  std::string names = "timestamp";
  for (const rtde::OutputField & field : rtde::output_fields()) {
    if (field.name != "timestamp" && field.name != "actual_execution_time" &&
        rtde::find_output_field(field.name, version) != nullptr) {
      names += "," + field.name;
    }
  }
  return names;
}

using Recording = std::map<double, std::string>;  // data packages by time

class ReplayTest : public ::testing::Test {
 protected:
  ReplayTest() { std::ofstream(path) << scenario; }
  ~ReplayTest() override { std::filesystem::remove(path); }

  Recording record(std::uint64_t seed, double real_time_factor) const
  {
    SimulatorOptions options = with_unique_address();
    options.world_file = path.string();
    options.seed = seed;
    options.real_time_factor = real_time_factor;
    options.recovery_time_factor = 0.1;
    SimulatedController controller(options);
    RtdeClient client(controller.address());
    EXPECT_TRUE(client.negotiate(2));
    const std::string types = client.setup_outputs(500.0, output_names(*PolyscopeVersion::parse("5.25.1")));
    EXPECT_EQ(types.find("NOT_FOUND"), std::string::npos);
    EXPECT_TRUE(client.start());
    Recording recording;
    for (double time = 0.0; time < end;) {
      const std::string package = client.receive('U').payload;
      time = decode_double(package.substr(1, 8));
      recording[time] = package;
    }
    EXPECT_LT(recording.begin()->first, first_event) << "the client was late";
    return recording;
  }

  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("replay_" + std::to_string(getpid()) + ".yaml");
};

/// Number of cycles that both recordings contain; adds those that differ to `different`. A client on a busy
/// host may lose packages.
int compare(const Recording & first, const Recording & second, int & different)
{
  int common = 0;
  for (const auto & [time, package] : first) {
    const auto other = second.find(time);
    if (other != second.end()) {
      ++common;
      different += other->second != package ? 1 : 0;
    }
  }
  return common;
}

TEST_F(ReplayTest, AWorldFileRunsBitForBitTheSameWithTheSameSeed)
{
  const Recording first = record(7, 1.0);
  const Recording second = record(7, 2.0);  // at another speed of the host
  int different = 0;
  EXPECT_GT(compare(first, second, different), 1000);
  EXPECT_EQ(different, 0);
}

TEST_F(ReplayTest, TheSeedSelectsTheSensorNoise)
{
  const Recording first = record(7, 2.0);
  const Recording second = record(8, 2.0);
  int different = 0;
  EXPECT_EQ(compare(first, second, different), different);
}

}  // namespace
}  // namespace ur_simulator::testing
