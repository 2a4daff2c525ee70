#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "urscript/code.hpp"
#include "urscript/machine.hpp"
#include "urscript/operators.hpp"
#include "urscript/thread.hpp"

namespace ur_simulator::urscript {

/// The threads and variables of a running program, and the execution of their instructions. Scheduling is the
/// Machine's.
class Interpreter {
 public:
  Interpreter(const Code & code, const Library & library, const MachineOptions & options);

  /// Lets a ready thread run until it waits, ends, or has spent its share of instructions; returns how many
  /// it spent.
  std::uint32_t run(Thread & thread, std::uint32_t share, CallContext & context);

  /// A thread that begins with the function, its arguments taken from the end of `arguments`.
  Thread & start(std::uint32_t function, std::span<Value> arguments);
  Thread * find(std::int32_t handle);
  void end(Thread & thread);
  void remove_ended();

  std::vector<std::unique_ptr<Thread>> & threads() { return threads_; }
  /// The thread inside of a critical section, 0: none.
  std::int32_t critical_owner() const { return critical_owner_; }
  bool halted() const { return halted_; }
  const std::optional<RunTimeError> & error() const { return error_; }
  void fail(std::int32_t line, std::string message);
  std::int32_t line_of(const Thread & thread) const;
  const std::string & name_of(const Thread & thread) const;
  const Value * global(const std::string & name) const;

 private:
  enum class Next : std::uint8_t { go_on, leave };

  Next execute(const Instruction & instruction);
  Next execute_rare(const Instruction & instruction);
  Next fail_here(std::string message);
  Next replace(std::size_t count, tl::expected<Value, std::string> result);

  void charge(const Value & value);
  void charge(std::span<const Value> values);

  Next load(const Value & value, const Instruction & instruction);
  Next binary_operator(Operator op);
  Next jump_keep(const Instruction & instruction, bool leaves_when);
  Next call(const Instruction & instruction);
  Next call_builtin(const Instruction & instruction);
  Next take(Outcome outcome, std::size_t arguments);
  Next return_value();
  Next store_path(const Instruction & instruction);
  Next method(const Instruction & instruction);
  Next run_thread(const Instruction & instruction);
  Next kill_or_join(bool join);
  Next leave_critical();

  Value & local(std::uint32_t slot) { return thread_->stack[thread_->frames.back().base + slot]; }
  Value & variable(const Path & path);
  Value pop();
  std::span<Value> top(std::size_t count) { return std::span(thread_->stack).last(count); }
  void drop(std::size_t count) { thread_->stack.resize(thread_->stack.size() - count); }

  const Code & code_;
  const Library & library_;
  const MachineOptions & options_;
  std::vector<Value> globals_;
  std::vector<std::unique_ptr<Thread>> threads_;
  std::int32_t next_handle_ = 1;
  std::int32_t critical_owner_ = 0;
  bool halted_ = false;
  std::optional<RunTimeError> error_;

  Thread * thread_ = nullptr;        ///< that runs now
  CallContext * context_ = nullptr;  ///< of its builtins
  std::uint32_t cost_ = 0;           ///< spent by it in this cycle
};

}  // namespace ur_simulator::urscript
