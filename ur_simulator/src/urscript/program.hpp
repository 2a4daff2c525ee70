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

/// A program and statements that are added while it runs. Its code, and that of earlier statements, keeps its
/// place, so that running threads can continue. Only added statements see their new variables. Adding takes
/// time in proportion to the statements alone.
class ExtendedProgram {
 public:
  /// `program` was compiled with this library, which outlives this object.
  ExtendedProgram(const Program & program, const Library & library, const CompileLimits & limits = {});
  ~ExtendedProgram();

  /// Adds statements at the first level. Returns the function in Code::functions that executes them. Changes
  /// nothing if they do not compile.
  tl::expected<std::uint32_t, CompileError> add(std::string_view statements);
  /// Grows with each call of add().
  const Code & code() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ur_simulator::urscript
