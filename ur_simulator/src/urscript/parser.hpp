#pragma once

#include <memory>
#include <string_view>
#include <tl/expected.hpp>

#include "urscript/program.hpp"
#include "urscript/syntax.hpp"

namespace ur_simulator::urscript {

/// The text as one definition: the only `def` or `sec` in it, or, for bare statements, a definition without a
/// name.
tl::expected<std::unique_ptr<Definition>, CompileError> parse(std::string_view text,
                                                              const CompileLimits & limits);

}  // namespace ur_simulator::urscript
