#pragma once

#include <string>
#include <vector>

#include "control_port/commands.hpp"

namespace ur_simulator {

/// A command of a world file, checked when the file is read.
struct WorldFileCommand {
  double time = 0.0;   ///< s of simulated time since the start; 0 for initial objects
  std::string origin;  ///< "cell.yaml:12: push", for messages
  control_port::Action action;
};

/// Content of a world file: the objects around the arm, and events on a time line (docs/use/simulator.md).
struct WorldFile {
  std::vector<WorldFileCommand> objects;  ///< executed before the first cycle
  std::vector<WorldFileCommand> events;   ///< sorted by time
};

/// Throws std::runtime_error with file, line, field, value and remedy if the file cannot be read or is
/// invalid.
WorldFile read_world_file(const std::string & path);
/// The same for the content of a file. `path` appears in messages.
WorldFile parse_world_file(const std::string & text, const std::string & path);

}  // namespace ur_simulator
