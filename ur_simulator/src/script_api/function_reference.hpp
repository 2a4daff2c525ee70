#pragma once

#include <string>
#include <vector>

#include "urscript/library.hpp"

namespace ur_simulator {

/// Markdown tables of the simplified builtins of a library with the difference, and of the rejected ones with
/// the reason.
std::string function_reference(const urscript::Library & library);

/// Names in Markdown code, for table cells of at most 120 characters: one for each row.
std::vector<std::string> code_cells(const std::vector<std::string> & names);

}  // namespace ur_simulator
