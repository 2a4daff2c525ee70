#pragma once

#include <string>
#include <vector>

#include "ur_simulator/simulated_controller.hpp"

namespace CLI {
class App;
}

namespace ur_simulator {

/// The options of the command line.
struct AppOptions {
  SimulatorOptions simulator;
  std::vector<double> surface_heights;  ///< horizontal surfaces, m
  unsigned count = 1;                   ///< robots, on consecutive addresses
  bool quiet = false;
  bool print_log = false;
  bool show_status = false;

  // Unparsed values, evaluated by parse_values().
  std::vector<std::string> surface_texts;
  std::vector<std::string> port_texts;
  std::vector<double> joints;
  bool powered_off = false;
  bool local_control = false;
  bool ignore_collisions = false;
};

/// Adds description and options to the command line.
void add_options(CLI::App & app, AppOptions & options);
/// Evaluates the unparsed values. Throws std::runtime_error with option and value if one is invalid.
void parse_values(AppOptions & options);

}  // namespace ur_simulator
