#pragma once

#include <optional>
#include <string_view>

#include "polyscope/pendant.hpp"

namespace ur_simulator {

/// Executes a controller command: a line outside any program on a client interface, such as `power on` or
/// `stop program`. PolyScope and UR's client library send them; the script manual does not describe them.
/// Returns nullopt if the text is not a controller command.
std::optional<Pendant::Result> execute_controller_command(Pendant & pendant, std::string_view text);

}  // namespace ur_simulator
