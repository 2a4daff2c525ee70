#pragma once

#include <string>

#include "urscript/library.hpp"

namespace ur_simulator {

/// Markdown tables of the simplified builtins of a library with the difference, and of the rejected ones with
/// the reason.
std::string function_reference(const urscript::Library & library);

}  // namespace ur_simulator
