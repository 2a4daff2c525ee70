#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ur_simulator/simulated_controller.hpp"

namespace CLI {
class App;
}

namespace ur_simulator {

struct AppOptions {
  SimulatorOptions simulator;
  std::vector<double> surfaces;  ///< heights of horizontal surfaces, m
  std::vector<std::string> surface_texts;
  std::vector<std::string> port_texts;
  std::vector<double> joints;
  bool powered_off = false;
  bool local_control = false;
  bool quiet = false;
  bool log = false;
};

void declare(CLI::App & app, AppOptions & options);
/// Turns what was given as text into values; throws std::runtime_error that names option and value.
void complete(AppOptions & options);

}  // namespace ur_simulator
