#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>

#include "urscript/code.hpp"
#include "urscript/program.hpp"

namespace ur_simulator::urscript {

/// Appends instructions and their constants to a Code. Throws CompileError when the program outgrows its
/// limit.
class Emitter {
 public:
  Emitter(Code & code, const CompileLimits & limits) : code_(code), limits_(limits) {}

  /// The line that following instructions belong to.
  void at_line(std::int32_t line) { line_ = line; }
  std::int32_t line() const { return line_; }
  std::uint32_t emit(Op op, std::uint32_t a = 0, std::uint32_t b = 0);
  /// A jump whose target is set by land().
  std::uint32_t jump(Op op) { return emit(op); }
  void land(std::uint32_t jump) { code_.instructions[jump].a = here(); }
  std::uint32_t here() const { return static_cast<std::uint32_t>(code_.instructions.size()); }
  void constant(const Value & value);
  std::uint32_t name(const std::string & name);

 private:
  Code & code_;
  const CompileLimits & limits_;
  std::int32_t line_ = 1;
  std::unordered_map<std::string, std::uint32_t> names_;
  std::unordered_map<std::int32_t, std::uint32_t> integers_;
};

}  // namespace ur_simulator::urscript
