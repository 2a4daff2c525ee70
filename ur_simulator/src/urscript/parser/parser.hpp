#pragma once

#include <memory>
#include <string_view>
#include <tl/expected.hpp>

#include "urscript/parser/syntax.hpp"
#include "urscript/program.hpp"

namespace ur_simulator::urscript {

/// Parses a text into one definition: the only `def` or `sec` in it, or a definition without a name for bare
/// statements.
tl::expected<std::unique_ptr<Definition>, CompileError> parse(std::string_view text,
                                                              const CompileLimits & limits);

/// Parses statements that extend a program.
tl::expected<std::unique_ptr<Definition>, CompileError> parse_statements(std::string_view text,
                                                                         const CompileLimits & limits);

}  // namespace ur_simulator::urscript
