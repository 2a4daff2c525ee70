#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace ur_simulator::urscript {

class Library;
struct Code;

/// A syntax or name error in a program. Line and column are 1-based.
struct CompileError {
  std::int32_t line = 0;
  std::int32_t column = 0;
  std::string message;
  std::string undefined_name = {};  ///< if the error is that a function, thread or variable is not defined
  std::optional<std::string> source_line = std::nullopt;  ///< the text of the line, of a syntax error

  /// "Compile error on line 3, column 5: …"
  std::string text() const;
};

/// Limits that protect the controller from malicious or broken programs.
struct CompileLimits {
  std::size_t text_bytes = 4U << 20U;
  std::size_t nesting = 128;   ///< of expressions and blocks
  std::size_t nodes = 500000;  ///< of the syntax tree
  std::size_t instructions = 1U << 20U;
};

/// A compiled program: immutable, can run any number of times.
class Program {
 public:
  explicit Program(std::shared_ptr<const Code> code);

  /// The name after `def` or `sec`; "" for bare statements.
  const std::string & name() const;
  /// True for a secondary program (`sec`), which runs beside the primary program and may not take physical
  /// time.
  bool is_secondary() const;
  const Code & code() const { return *code_; }

 private:
  std::shared_ptr<const Code> code_;
};

/// Compiles `def name(): … end`, `sec name(): … end`, or bare statements, as received by External Control and
/// on the script ports. Unknown functions are compile errors, as on the robot. The program contains indices
/// into `library` and must be run with the same library.
tl::expected<Program, CompileError> compile(std::string_view text, const Library & library,
                                            const CompileLimits & limits = {});

/// A program with statements that were added while it runs.
struct ExtendedProgram {
  Program program;
  std::uint32_t function;  ///< in Code::functions: executes the statements
};

/// Adds statements at the first level of a program. Its code, and that of earlier extensions, keeps its
/// place, so that running threads can continue. Only extensions see the new variables of the statements.
/// Compiles the whole program again.
tl::expected<ExtendedProgram, CompileError> extend(const Program & program, std::string_view statements,
                                                   const Library & library,
                                                   const CompileLimits & limits = {});

}  // namespace ur_simulator::urscript
