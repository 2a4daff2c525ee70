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

/// Context of a call of a builtin.
struct CallContext {
  Host & host;
  double cycle_time;      ///< s
  double time;            ///< s of simulated time since the program started
  std::int32_t line;      ///< of the call, 1-based
  bool secondary;         ///< called from a secondary program (`sec`), which may not take physical time
  std::uint64_t program;  ///< identifies the execution of the program
};

/// A call of a builtin that takes physical time. It is polled once per control cycle, first in the cycle
/// after the call, and destroyed after it returned its value or after cancel().
class Operation {
 public:
  virtual ~Operation() = default;
  /// The value of the call, nothing while it is in progress, or the error that ends the program.
  virtual tl::expected<std::optional<Value>, std::string> poll(CallContext & context) = 0;
  /// The thread was killed or the program stopped; poll() is not called again.
  virtual void cancel() {}
};

/// The call returns this value in the next cycle, as sync() does.
struct NextCycle {
  Value value;
};

/// A run-time error: stops the program and is logged.
struct Failure {
  std::string message;
};

/// Stops the program without an error, as `halt` does.
struct Halt {};

using Outcome = std::variant<Value, NextCycle, std::unique_ptr<Operation>, Failure, Halt>;

/// One value per parameter of the builtin. A parameter without default that was not passed is Type::none.
using Arguments = std::span<const Value>;
using BuiltinFunction = std::function<Outcome(CallContext & context, Arguments arguments)>;

struct Parameter {
  Parameter(std::string parameter_name)
      : name(std::move(parameter_name)) {}                          // NOLINT(google-explicit-constructor)
  Parameter(const char * parameter_name) : name(parameter_name) {}  // NOLINT(google-explicit-constructor)
  Parameter(std::string parameter_name, Value value)
      : name(std::move(parameter_name)), default_value(std::move(value))
  {
  }

  std::string name;
  Value default_value;
};

struct Builtin {
  std::string name;
  std::vector<Parameter> parameters;
  std::size_t required = 0;  ///< number of parameters that a call must pass
  BuiltinFunction function;
  bool variadic = false;    ///< accepts further positional arguments
  std::uint32_t cost = 15;  ///< of a call, in instructions of about 20 ns
};

/// Builtin functions and constants by name. Immutable once it is shared.
class Library {
 public:
  /// Replaces a builtin of the same name.
  void add(Builtin builtin);
  /// Adds a constant that programs can read, such as MATH_PI.
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

/// Adds the builtins that need no robot: math, lists, matrices, strings, poses, sleep, sync, halt, textmsg,
/// popup, time.
void add_standard_builtins(Library & library);

}  // namespace ur_simulator::urscript
