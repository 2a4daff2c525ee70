#pragma once

#include <gtest/gtest.h>

#include <string>

#include "address.hpp"
#include "ur_simulator/simulated_controller.hpp"

namespace ur_simulator::testing {

using nlohmann::json;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// Options of a controller on an address of its own.
inline SimulatorOptions on_own_address(SimulatorOptions options = {})
{
  options.address = next_address();
  return options;
}

/// Does the log hold an entry with this text?
inline bool logged(SimulatedController & controller, const std::string & text)
{
  const json reply = controller.control({{"command", "log"}});
  for (const json & entry : reply.at("entries")) {
    if (entry.at("text").get<std::string>().find(text) != std::string::npos) {
      return true;
    }
  }
  return false;
}

inline bool wait_for_log(SimulatedController & controller, const std::string & text)
{
  // The log is no part of the state: look at it once a cycle at most.
  for (int i = 0; i < 5000; ++i) {
    if (logged(controller, text)) {
      return true;
    }
    controller.wait_until([cycle = controller.state()["cycle"].get<int>()](
                              const json & state) { return state["cycle"].get<int>() > cycle; },
                          seconds(1));
  }
  return false;
}

inline bool wait_for_program(SimulatedController & controller, const std::string & state)
{
  return controller.wait_until([&](const json & now) { return now["program"]["state"] == state; },
                               seconds(10));
}

/// One controller a test, on an address of its own.
class SimulatorTest : public ::testing::Test {
 protected:
  SimulatedController controller{on_own_address()};
};

}  // namespace ur_simulator::testing
