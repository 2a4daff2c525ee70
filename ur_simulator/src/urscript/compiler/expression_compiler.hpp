#pragma once

#include <string>

#include "urscript/compiler/emitter.hpp"
#include "urscript/compiler/symbol_table.hpp"
#include "urscript/library.hpp"

namespace ur_simulator::urscript {

/// Emits the instructions of expressions. Throws CompileError, which compile() catches.
class ExpressionCompiler {
 protected:
  ExpressionCompiler(Code & code, SymbolTable & symbols, const Library & library,
                     const CompileLimits & limits)
      : code_(code), symbols_(symbols), library_(library), emitter_(code, limits)
  {
  }

  void compile_expression(const Expression & expression);
  /// Emits the indices of an lvalue such as `a[i].b` and returns its index in Code::lvalues.
  std::uint32_t make_lvalue(const Expression & target);
  Variable variable(const Expression & expression);
  /// The indexed name of the library that an expression such as `digital_out[2]` refers to, or nullptr.
  const IndexedName * indexed_name(const Expression & expression) const;
  void emit_store(const Variable & variable);

  Emitter & emitter() { return emitter_; }
  Code & code() { return code_; }
  SymbolTable & symbols() { return symbols_; }
  Scope & scope() { return *scope_; }
  void enter_scope(Scope & scope) { scope_ = &scope; }
  [[noreturn]] static void fail(const Expression & where, std::string message);
  /// Fails because there is no function, thread or variable (`kind`) with the name of the expression.
  [[noreturn]] static void fail_undefined(const Expression & where, std::string_view kind);

 private:
  /// An expression whose operands are all evaluated first.
  void compile_operation(const Expression & expression);
  void emit_load(const Expression & expression);
  void compile_structure(const Expression & expression);
  void compile_chain(const Expression & expression);
  void compile_short_circuit(const Expression & expression, std::size_t first, std::size_t last);
  void compile_call(const Expression & expression);
  void compile_function_call(const Expression & expression, const Definition & definition, Opcode op);
  void compile_builtin_call(const Expression & expression, std::uint32_t index);
  void compile_method_call(const Expression & expression);
  bool is_lvalue(const Expression & expression) const;
  void collect_lvalue(const Expression & target, Lvalue & lvalue);

  Code & code_;
  SymbolTable & symbols_;
  const Library & library_;
  Emitter emitter_;
  Scope * scope_ = nullptr;
};

}  // namespace ur_simulator::urscript
