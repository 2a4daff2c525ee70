#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>

#include "urscript/compiler/code.hpp"
#include "urscript/program.hpp"

namespace ur_simulator::urscript {

/// Appends instructions and constants to a Code. Throws CompileError if the program exceeds the limit.
class Emitter {
 public:
  Emitter(Code & code, const CompileLimits & limits) : code_(code), limits_(limits) {}

  /// Sets the source line of the following instructions.
  void set_line(std::int32_t line) { line_ = line; }
  std::int32_t line() const { return line_; }
  std::uint32_t emit(Opcode op, std::uint32_t a = 0, std::uint32_t b = 0);
  /// Emits a jump; its target is set by patch_jump().
  std::uint32_t emit_jump(Opcode op) { return emit(op); }
  void patch_jump(std::uint32_t jump) { code_.instructions[jump].a = next_index(); }
  std::uint32_t next_index() const { return static_cast<std::uint32_t>(code_.instructions.size()); }
  void emit_constant(const Value & value);
  std::uint32_t name_index(const std::string & name);

 private:
  Code & code_;
  const CompileLimits & limits_;
  std::int32_t line_ = 1;
  std::unordered_map<std::string, std::uint32_t> names_;
  std::unordered_map<std::int32_t, std::uint32_t> integers_;
};

}  // namespace ur_simulator::urscript
