#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace ur_simulator {

/// The text as one line of printable ASCII characters: line ends and other bytes are escaped as \n, \r, \t or
/// \xNN, a backslash as \\. Of a text that is longer than `limit` bytes, the beginning is returned, with the
/// number of omitted bytes.
std::string printable(std::string_view text, std::size_t limit);

/// Replaces the characters that have a meaning in Mermaid by their entity codes, such as #59; for a
/// semicolon.
std::string escape_mermaid(std::string_view text);

}  // namespace ur_simulator
