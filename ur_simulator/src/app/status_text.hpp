#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace ur_simulator {

/// What the status shows of a robot.
struct RobotStatus {
  std::string address;
  nlohmann::json state;     ///< as the control port reports it
  std::string last_error;   ///< "": none
  double real_time_factor;  ///< simulated seconds per second of the host, recently
};

/// What changes only with an event, on one line: modes, program, clients, last error.
std::string describe_state(const RobotStatus & status);

/// The lines that a terminal of this size shows: four lines for one robot, one line for each of several.
std::vector<std::string> status_lines(const std::vector<RobotStatus> & robots, std::size_t columns,
                                      std::size_t rows);

}  // namespace ur_simulator
