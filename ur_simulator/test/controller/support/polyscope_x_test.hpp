#pragma once

#include "http_client.hpp"
#include "simulator_test.hpp"

namespace ur_simulator::testing {

/// Options of a controller with this version of PolyScope X. The port of its Robot API is free.
inline SimulatorOptions polyscope_x_options(const std::string & version)
{
  SimulatorOptions options = with_unique_address();
  options.polyscope_version = version;
  options.ports.robot_api = 0;
  options.recovery_time_factor = 0.1;
  return options;
}

/// A controller with PolyScope X and a client of its Robot API.
class PolyscopeXTest : public ::testing::Test {
 protected:
  explicit PolyscopeXTest(const std::string & version = "10.14.0") : controller(polyscope_x_options(version))
  {
  }

  void store_program(const std::string & name, const std::string & script)
  {
    ASSERT_TRUE(controller.control({{"command", "store_program"}, {"name", name}, {"script", script}})["ok"]);
  }

  SimulatedController controller;
  HttpClient client{controller.address(), controller.ports().robot_api};
};

}  // namespace ur_simulator::testing
