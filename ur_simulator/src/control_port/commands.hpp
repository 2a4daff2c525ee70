#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "control_port/control_port_context.hpp"
#include "control_port/request_fields.hpp"

namespace ur_simulator::control_port {

/// Executes a request whose fields have been checked. Returns the fields of the reply; throws if the command
/// is rejected in the current state.
using Action = std::function<nlohmann::json(ControlPortContext & context)>;

/// A command of the control port.
struct Command {
  std::string_view name;
  std::string_view fields;  ///< for help: names, units, ranges, defaults
  std::string_view help;    ///< one sentence
  /// Reads the fields. Throws RequestError if one is invalid.
  Action (*prepare)(RequestFields & fields);
};

std::span<const Command> world_commands();       ///< surfaces, pushes, loads, joint positions, inputs
std::span<const Command> gripper_commands();     ///< objects and faults of the grippers
std::span<const Command> robot_commands();       ///< power, safety, programs, pendant
std::span<const Command> connection_commands();  ///< connection faults, reboot
std::span<const Command> query_commands();       ///< state, registers, log, trace

/// Checks a request. Throws RequestError if the command or a field is unknown, missing or invalid.
Action prepare_request(const nlohmann::json & request);
/// Executes a request. The reply has the field "ok"; if it is false, "error" states field, value and limit.
nlohmann::json execute_request(ControlPortContext & context, const nlohmann::json & request);

/// The state as the command "state" reports it.
nlohmann::json state_to_json(const ControlPortContext & context);

}  // namespace ur_simulator::control_port
