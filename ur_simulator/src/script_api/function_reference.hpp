#pragma once

#include <string>

#include "urscript/library.hpp"

namespace ur_simulator {

/// The builtins of a library as Markdown tables: by group, with their simplifications, and the rejected ones
/// with the reason.
std::string function_reference(const urscript::Library & library);

}  // namespace ur_simulator
