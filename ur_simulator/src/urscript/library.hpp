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

/// Adds statements to a running program, for interpreter mode.
class ProgramExtension {
 public:
  virtual ~ProgramExtension() = default;
  /// Compiles statements. Returns the function that executes them, or why they cannot be compiled.
  virtual tl::expected<std::uint32_t, std::string> add(std::string_view statements) = 0;
  /// Removes all added statements with their functions and variables, and ends the threads that they and
  /// their functions have started. No thread may execute an added statement.
  virtual void remove_all() = 0;
};

/// Context of a call of a builtin.
struct CallContext {
  Host & host;
  double cycle_time;      ///< s
  double time;            ///< s of simulated time, see MachineOptions::clock
  std::int32_t line;      ///< of the call, 1-based
  bool secondary;         ///< called from a secondary program (`sec`), which may not take physical time
  std::uint64_t program;  ///< identifies the execution of the program
  ProgramExtension & extension;
  bool main_thread = false;  ///< called from the main thread of the program
  /// Set by a builtin that returned data from outside without taking physical time. A thread that receives
  /// data is not an infinite loop.
  bool received_data = false;
};

/// A call of a builtin that takes physical time. It is polled once per control cycle, first in the cycle
/// after the call, and destroyed after it returned its value or after cancel().
class PendingCall {
 public:
  virtual ~PendingCall() = default;
  /// The value of the call, nothing while it is in progress, or the error that ends the program.
  virtual tl::expected<std::optional<Value>, std::string> poll(CallContext & context) = 0;
  /// Asked after each poll() without a value: a function of the program that the thread executes before the
  /// next poll().
  virtual std::optional<std::uint32_t> next_function() { return std::nullopt; }
  /// Whether it only waits for another machine. A secondary program may call it if the wait is short.
  virtual bool is_network_call() const { return false; }
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

using Outcome = std::variant<Value, NextCycle, std::unique_ptr<PendingCall>, Failure, Halt>;

/// One value per parameter of the builtin. A parameter without default that was not passed is Type::none.
using Arguments = std::span<const Value>;

/// A value whose methods are executed outside of the program, such as the handle of rpc_factory().
class RemoteObject {
 public:
  virtual ~RemoteObject() = default;
  virtual Outcome call(const std::string & method, Arguments arguments) = 0;
};

using BuiltinFunction = std::function<Outcome(CallContext & context, Arguments arguments)>;

struct Parameter {
  Parameter(std::string parameter_name)
      : name(std::move(parameter_name)) {}                          // NOLINT(google-explicit-constructor)
  Parameter(const char * parameter_name) : name(parameter_name) {}  // NOLINT(google-explicit-constructor)
  Parameter(std::string parameter_name, Value value)
      : name(std::move(parameter_name)), default_value(std::move(value))
  {
  }

  /// The same parameter with the name that an earlier version of the script manual uses.
  Parameter formerly(std::string earlier) const
  {
    Parameter parameter = *this;
    parameter.former_name = std::move(earlier);
    return parameter;
  }
  bool is_called(std::string_view argument) const
  {
    return argument == name || (!former_name.empty() && argument == former_name);
  }

  std::string name;
  Value default_value;
  std::string former_name;
};

/// A name that early programs index like a list: `digital_out[2] = True`.
struct IndexedName {
  std::uint32_t getter;                 ///< builtin that takes the index
  std::optional<std::uint32_t> setter;  ///< builtin that takes the index and the value
};

/// How a builtin compares with the robot's.
enum class Support : std::uint8_t {
  modelled,
  simplified,  ///< accepts the same calls; Builtin::note says what differs
  rejected,    ///< calls fail; Builtin::note says why
};

struct Builtin {
  std::string name;
  std::vector<Parameter> parameters;
  std::size_t required = 0;  ///< number of parameters that a call must pass
  BuiltinFunction function;
  bool variadic = false;    ///< accepts further positional arguments
  std::uint32_t cost = 15;  ///< of a call, in instructions of about 20 ns
  Support support = Support::modelled;
  std::string note = {};  ///< what is simplified, or why calls fail
};

/// Builtin functions and constants by name. Immutable once it is shared.
class Library {
 public:
  /// Replaces a builtin of the same name.
  void add(Builtin builtin);
  /// Adds a builtin whose calls fail with this reason.
  void add_rejected(std::string name, std::vector<Parameter> parameters, std::size_t required,
                    std::string reason);
  /// Documents what the current builtin of this name simplifies. Throws std::out_of_range if there is none.
  void simplify(std::string_view name, std::string note);
  /// Makes the builtin of this name unknown to programs. Throws std::out_of_range if there is none.
  void hide(std::string_view name);
  /// Adds a constant that programs can read, such as MATH_PI.
  void add_constant(std::string name, Value value);

  /// Adds a name that is indexed. Throws std::out_of_range if there are no builtins of these names.
  void add_indexed_name(std::string name, std::string_view getter, std::string_view setter = "");
  /// Adds a function that is called after a program has ended in any way, with CallContext::program.
  void add_end_handler(std::function<void(std::uint64_t program)> handler);

  std::optional<std::uint32_t> find(std::string_view name) const;
  const Builtin & operator[](std::uint32_t index) const { return builtins_[index]; }
  std::size_t size() const { return builtins_.size(); }
  const Value * constant(const std::string & name) const;
  const IndexedName * indexed_name(const std::string & name) const;
  void handle_end(std::uint64_t program) const;

 private:
  std::uint32_t index_of(std::string_view name) const;

  std::vector<Builtin> builtins_;
  std::unordered_map<std::string, std::uint32_t> index_;
  std::unordered_map<std::string, Value> constants_;
  std::unordered_map<std::string, IndexedName> indexed_names_;
  std::vector<std::function<void(std::uint64_t program)>> end_handlers_;
};

/// Adds the builtins that need no robot: math, lists, matrices, strings, poses, sleep, sync, halt, textmsg,
/// popup, time.
void add_standard_builtins(Library & library);

}  // namespace ur_simulator::urscript
