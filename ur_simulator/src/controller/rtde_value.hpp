#pragma once

#include <optional>
#include <string_view>

#include "state/controller_state.hpp"
#include "urscript/value.hpp"
#include "version/polyscope_version.hpp"

namespace ur_simulator {

/// The value of an RTDE output as get_rtde_value() returns it: bool, integer (a number that exceeds the range
/// of integers: floating), floating, or a list of numbers. Nothing if the version has no such output.
std::optional<urscript::Value> rtde_value(const ControllerState & state, const PolyscopeVersion & version,
                                          std::string_view name);

}  // namespace ur_simulator
