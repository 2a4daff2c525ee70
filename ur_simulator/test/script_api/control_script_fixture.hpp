#pragma once

#include <algorithm>
#include <fstream>
#include <sstream>

#include "script_fixture.hpp"

namespace ur_simulator {

/// Prepares the script for PolyScope 5.25 as ur_rtde's ScriptClient does: selects the lines of that version
/// and inserts the register offset.
inline std::string uploaded_script(const std::string & offset)
{
  std::ifstream file(UR_RTDE_CONTROL_SCRIPT);
  std::stringstream result;
  result << "def rtde_control():\n";
  std::string line;
  while (std::getline(file, line)) {
    if (!line.empty() && line[0] == '$') {
      const bool alternative = line.size() > 9 && line[5] == '|';
      const std::size_t marker = alternative ? 10 : 5;
      const int minor = std::stoi(line.substr(3, 2));
      if (line[1] == '5' && minor > 25) {
        continue;
      }
      line.replace(0, marker, std::string(marker, ' '));
    }
    result << line << "\n";
    if (line.find("# float register offset") != std::string::npos ||
        line.find("# int register offset") != std::string::npos) {
      result << offset;
    }
  }
  result << "end\n";
  return result.str();
}

/// The control script of the installed ur_rtde, running and ready. The build defines the path of the script.
class ControlScriptTest : public ::testing::Test {
 protected:
  void SetUp() override
  {
    fixture.run(uploaded_script("0"));
    fixture.until([&] { return output(0) == 1; }, 0.1);
  }

  std::int32_t output(std::size_t i) const { return fixture.state.outputs.integers[i]; }

  void parameters(const Vector6 & six, std::initializer_list<double> more = {})
  {
    for (std::size_t i = 0; i < 6; ++i) {
      fixture.state.inputs.floats[i] = static_cast<float>(six[static_cast<Eigen::Index>(i)]);
    }
    std::transform(more.begin(), more.end(), fixture.state.inputs.floats.begin() + 6,
                   [](double value) { return static_cast<float>(value); });
  }

  /// Sends one command like ur_rtde: waits until the script reports `done`, then until it is ready again.
  double command(std::int32_t id, double limit = 30.0)
  {
    fixture.state.inputs.integers[0] = id;
    const double time = fixture.until([&] { return output(0) == 2; }, limit);
    fixture.state.inputs.integers[0] = 0;
    fixture.until([&] { return output(0) == 1; }, 0.1);
    return time;
  }

  void expect_running()
  {
    EXPECT_EQ(fixture.machine->status(), urscript::MachineStatus::running)
        << fixture.machine->error().message;
  }

  ScriptFixture fixture;
};

}  // namespace ur_simulator
