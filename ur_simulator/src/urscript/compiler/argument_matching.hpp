#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "urscript/parser/syntax.hpp"

namespace ur_simulator::urscript {

constexpr std::uint32_t no_argument = 0xFFFFFFFF;

/// Whether the parameter at this position has this name.
using NameTest = std::function<bool(std::size_t position, const std::string & name)>;

/// For each parameter, the index of the operand that the call passes for it, or `no_argument`. Calls `fail`,
/// which throws, if the arguments do not fit the parameters.
std::vector<std::uint32_t> match_arguments(const Expression & call, std::size_t parameters,
                                           const std::function<std::string(std::size_t)> & parameter_name,
                                           const NameTest & is_called,
                                           const std::function<void(std::string)> & fail);

}  // namespace ur_simulator::urscript
