#pragma once

#include <string>

#include "urscript/emitter.hpp"
#include "urscript/library.hpp"
#include "urscript/scope.hpp"

namespace ur_simulator::urscript {

/// Instructions for expressions. Throws CompileError; compile() catches it.
class ExpressionCompiler {
 protected:
  ExpressionCompiler(Code & code, Scopes & scopes, const Library & library, const CompileLimits & limits)
      : code_(code), scopes_(scopes), library_(library), emitter_(code, limits)
  {
  }

  void expression(const Expression & expression);
  /// The variable and steps of `a[i].b`; emits the indices.
  std::uint32_t path(const Expression & target);
  Variable variable(const Expression & expression);
  void store(const Variable & variable);

  Emitter & emitter() { return emitter_; }
  Code & code() { return code_; }
  Scopes & scopes() { return scopes_; }
  Scope & scope() { return *scope_; }
  void enter(Scope & scope) { scope_ = &scope; }
  [[noreturn]] static void fail(const Expression & where, std::string message);

 private:
  void load(const Expression & expression);
  void structure(const Expression & expression);
  void chain(const Expression & expression);
  void logical_run(const Expression & expression, std::size_t first, std::size_t last);
  void call(const Expression & expression);
  void call_defined(const Expression & expression, const Definition & definition, Op op);
  void call_builtin(const Expression & expression, std::uint32_t index);
  void method(const Expression & expression);
  bool is_path(const Expression & expression) const;
  void collect_path(const Expression & target, Path & path);

  Code & code_;
  Scopes & scopes_;
  const Library & library_;
  Emitter emitter_;
  Scope * scope_ = nullptr;
};

}  // namespace ur_simulator::urscript
