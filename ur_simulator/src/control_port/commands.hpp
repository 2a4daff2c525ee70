#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "control_port/bench.hpp"
#include "control_port/fields.hpp"

namespace ur_simulator::control_port {

/// One command of the control port.
struct Command {
  std::string_view name;
  std::string_view fields;  ///< for help: names, units, ranges, defaults
  std::string_view help;    ///< one sentence
  /// Reads its fields, calls Fields::finish(), then acts. The object returned is merged into the reply.
  nlohmann::json (*run)(Bench & bench, Fields & fields);
};

std::span<const Command> world_commands();    ///< surfaces, pushes, loads, teleport, inputs
std::span<const Command> robot_commands();    ///< power, safety, programs, pendant
std::span<const Command> link_commands();     ///< faults of the connections
std::span<const Command> inquiry_commands();  ///< state, log

/// Carries out one request. Always an object with "ok"; when false, "error" names field, value and limit.
nlohmann::json handle(Bench & bench, const nlohmann::json & request);

}  // namespace ur_simulator::control_port
