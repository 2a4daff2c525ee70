#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <unordered_map>
#include <variant>
#include <vector>

#include "urscript/host.hpp"
#include "urscript/value.hpp"

namespace ur_simulator::urscript {

/// What a builtin sees of the machine that calls it.
struct CallContext {
  Host & host;
  double cycle_time;      ///< s
  double time;            ///< s since the program started, of the simulation
  std::int32_t line;      ///< of the call, 1-based
  bool secondary;         ///< called from a `sec` program, which may not take physical time
  std::uint64_t program;  ///< identifies the run of the program
};

/// A builtin that takes time. Polled once in each control cycle, the first time in the cycle after the call;
/// destroyed after it yielded its value, or after abandon().
class Operation {
 public:
  virtual ~Operation() = default;
  /// The call's value, nothing while it goes on, or why the program fails.
  virtual tl::expected<std::optional<Value>, std::string> poll(CallContext & context) = 0;
  /// The thread was killed or the program stopped: nobody will poll again.
  virtual void abandon() {}
};

/// The call's value, from the next cycle on: what sync() does, without an Operation.
struct NextCycle {
  Value value;
};

/// A run-time error: the program stops and the message goes to the log.
struct Failure {
  std::string message;
};

/// Stops the whole program without an error, as halt does.
struct Halt {};

using Outcome = std::variant<Value, NextCycle, std::unique_ptr<Operation>, Failure, Halt>;

/// One for each parameter of the builtin; a parameter without default that was not given is Type::none.
using Arguments = std::span<const Value>;
using BuiltinFunction = std::function<Outcome(CallContext & context, Arguments arguments)>;

struct Parameter {
  Parameter(std::string parameter_name)
      : name(std::move(parameter_name)) {}                          // NOLINT(google-explicit-constructor)
  Parameter(const char * parameter_name) : name(parameter_name) {}  // NOLINT(google-explicit-constructor)
  Parameter(std::string parameter_name, Value value)
      : name(std::move(parameter_name)), fallback(std::move(value))
  {
  }

  std::string name;
  Value fallback;
};

struct Builtin {
  std::string name;
  std::vector<Parameter> parameters;
  std::size_t required = 0;  ///< how many of the parameters a call must give
  BuiltinFunction function;
  bool variadic = false;    ///< takes further positional arguments
  std::uint32_t cost = 15;  ///< of a call in units of instructions, about 20 ns each
};

/// The functions that programs find by name. Filled once, then shared and never changed.
class Library {
 public:
  /// Replaces a builtin of the same name.
  void add(Builtin builtin);
  /// A name that a program can read without declaring it (a constant, such as MATH_PI).
  void add_constant(std::string name, Value value);

  std::optional<std::uint32_t> find(std::string_view name) const;
  const Builtin & operator[](std::uint32_t index) const { return builtins_[index]; }
  std::size_t size() const { return builtins_.size(); }
  const Value * constant(const std::string & name) const;

 private:
  std::vector<Builtin> builtins_;
  std::unordered_map<std::string, std::uint32_t> index_;
  std::unordered_map<std::string, Value> constants_;
};

/// Adds what needs no robot: math, lists, matrices, strings, poses, sleep, sync, halt, textmsg, popup,
/// assert, time.
void add_standard_builtins(Library & library);

}  // namespace ur_simulator::urscript
