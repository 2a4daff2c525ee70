#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace ur_simulator::urscript {

class Library;
struct Code;

/// Why a text is not a program. Line and column are 1-based positions in the text.
struct CompileError {
  std::int32_t line = 0;
  std::int32_t column = 0;
  std::string message;

  /// "Syntax error on line 3, column 5: …", as the controller's log shows it.
  std::string text() const;
};

/// Limits that keep a hostile text from exhausting the controller.
struct CompileLimits {
  std::size_t text_bytes = 4U << 20U;
  std::size_t nesting = 128;   ///< of expressions and blocks
  std::size_t nodes = 500000;  ///< of the syntax tree
  std::size_t instructions = 1U << 20U;
};

/// A compiled program: immutable, may run any number of times.
class Program {
 public:
  explicit Program(std::shared_ptr<const Code> code);

  /// The name after `def` or `sec`; "" for a bare statement.
  const std::string & name() const;
  /// A `sec` program: runs beside the primary one, and may not take physical time.
  bool secondary() const;
  const Code & code() const { return *code_; }

 private:
  std::shared_ptr<const Code> code_;
};

/// Compiles `def name(): … end`, `sec name(): … end`, or bare statements (as External Control and the script
/// ports get them). Unknown functions are errors here, as on the robot. The program keeps indices into
/// `library`: run it with the same one.
tl::expected<Program, CompileError> compile(std::string_view text, const Library & library,
                                            const CompileLimits & limits = {});

}  // namespace ur_simulator::urscript
