#pragma once

#include <gtest/gtest.h>

#include <string>

#include "unique_address.hpp"
#include "ur_simulator/simulated_controller.hpp"

namespace ur_simulator::testing {

/// rad, m: more than the noise of the readings of joints and TCP poses.
constexpr double reading_noise = 3e-4;

using nlohmann::json;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// Returns the options with a unique address.
inline SimulatorOptions with_unique_address(SimulatorOptions options = {})
{
  options.address = unique_address();
  return options;
}

/// Returns whether an entry of the log contains the text.
inline bool log_contains(SimulatedController & controller, const std::string & text)
{
  const json reply = controller.control({{"command", "log"}});
  for (const json & entry : reply.at("entries")) {
    if (entry.at("text").get<std::string>().find(text) != std::string::npos) {
      return true;
    }
  }
  return false;
}

inline bool wait_for_next_cycle(SimulatedController & controller)
{
  return controller.wait_until([cycle = controller.state()["cycle"].get<int>()](
                                   const json & state) { return state["cycle"].get<int>() > cycle; },
                               seconds(1));
}

inline bool wait_for_log(SimulatedController & controller, const std::string & text)
{
  // The log is not part of the state: it is queried once per cycle.
  for (int i = 0; i < 5000; ++i) {
    if (log_contains(controller, text)) {
      return true;
    }
    wait_for_next_cycle(controller);
  }
  return false;
}

inline bool wait_for_program_state(SimulatedController & controller, const std::string & program_state)
{
  return controller.wait_until([&](const json & state) { return state["program"]["state"] == program_state; },
                               seconds(10));
}

inline bool wait_for_robot_mode(SimulatedController & controller, const std::string & mode, seconds timeout)
{
  return controller.wait_until([&](const json & state) { return state["robot_mode"] == mode; }, timeout);
}

inline bool wait_for_safety_mode(SimulatedController & controller, const std::string & mode, seconds timeout)
{
  return controller.wait_until([&](const json & state) { return state["safety_mode"] == mode; }, timeout);
}

/// Waits until the simulated time has advanced by `duration`, s.
inline bool wait_simulated_time(SimulatedController & controller, double duration, seconds timeout)
{
  const double end = controller.state()["timestamp"].get<double>() + duration;
  return controller.wait_until([end](const json & state) { return state["timestamp"].get<double>() >= end; },
                               timeout);
}

inline bool wait_until_at_rest(SimulatedController & controller, seconds timeout)
{
  return controller.wait_until([](const json & state) { return state["at_rest"].get<bool>(); }, timeout);
}

inline bool wait_until_moving(SimulatedController & controller, seconds timeout)
{
  return controller.wait_until([](const json & state) { return !state["at_rest"].get<bool>(); }, timeout);
}

/// A simulated controller with default options and a unique address.
class SimulatorTest : public ::testing::Test {
 protected:
  SimulatedController controller{with_unique_address()};
};

}  // namespace ur_simulator::testing
