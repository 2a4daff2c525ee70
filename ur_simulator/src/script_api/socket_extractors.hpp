#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "urscript/value.hpp"

// What the functions socket_read_… and socket_get_var take from the received bytes (script manual).

namespace ur_simulator::script_api {

/// Removes a value from the front of the received bytes; nothing while it is incomplete. A text without an
/// end is cut at the largest length of a string.
using Extractor = std::function<std::optional<urscript::Value>(std::string & received)>;

/// A line without its line end.
Extractor line_extractor();
/// The text between prefix and suffix. Without both: all received bytes.
Extractor string_extractor(std::string prefix, std::string suffix);
/// [count, value, …] from `count` big-endian integers of `size` bytes: unsigned bytes, or 32 bits.
Extractor integer_extractor(std::size_t count, std::size_t size);
/// [count, value, …] from `count` decimal numbers in parentheses, separated by commas: (1.5, 2, 3).
Extractor float_extractor(std::size_t count);
/// The number of the line "NAME number"; 0 if the line is different.
Extractor variable_extractor(std::string name);

/// Removes at most `count` bytes: [count, byte, …, -1, …].
urscript::Value available_bytes(std::string & received, std::size_t count);

/// Replaces the escape sequences \n, \r and \t.
std::string interpret_escapes(const std::string & text);

/// The result of a failed read of `count` numbers: [0, value, value, …].
urscript::Value failed_numbers(std::size_t count, const urscript::Value & value);

}  // namespace ur_simulator::script_api
