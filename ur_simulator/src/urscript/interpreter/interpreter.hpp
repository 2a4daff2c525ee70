#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "urscript/compiler/code.hpp"
#include "urscript/interpreter/operators.hpp"
#include "urscript/interpreter/thread.hpp"
#include "urscript/machine.hpp"

namespace ur_simulator::urscript {

/// Threads and variables of a running program and the execution of their instructions. Machine schedules the
/// threads.
class Interpreter {
 public:
  Interpreter(const Code & code, const Library & library, const MachineOptions & options);

  /// Runs a ready thread until it waits, ends or has used up its share of instructions. Returns the number of
  /// instructions used.
  std::uint32_t run(Thread & thread, std::uint32_t share, CallContext & context);

  /// Starts a thread that executes the function with these arguments.
  Thread & start_thread(std::uint32_t function, std::span<Value> arguments);
  Thread * find_thread(std::int32_t handle);
  void end_thread(Thread & thread);
  /// The thread executes the function before its operation goes on.
  void call_from_operation(Thread & thread, std::uint32_t function);
  /// Continues with the code of an extended program, or with that of the program before it was extended.
  void replace_code(const Code & code);
  /// Ends a thread and the threads that it and its children have started.
  void kill_thread(Thread & thread);
  /// Likewise for threads that run a function with this number or a higher one, or were started by one.
  void kill_threads_of_added_functions(std::size_t program_functions);
  void remove_ended();

  std::vector<std::unique_ptr<Thread>> & threads() { return threads_; }
  /// Handle of the thread that was interrupted by the end of its share in a critical section, 0: none. No
  /// other thread runs before it has left the section or waits.
  std::int32_t critical_owner() const { return critical_owner_; }
  bool halted() const { return halted_; }
  const std::optional<RunTimeError> & error() const { return error_; }
  void fail(std::int32_t line, std::string message);
  std::int32_t line_of(const Thread & thread) const;
  const std::string & name_of(const Thread & thread) const;
  const Value * global(const std::string & name) const;
  /// Memory of the values of all variables and stacks, bytes.
  std::size_t memory() const;

 private:
  enum class Next : std::uint8_t { proceed, yield };

  Next execute(const Instruction & instruction);
  Next execute_infrequent(const Instruction & instruction);
  Next execute_thread_instruction(const Instruction & instruction);
  Next fail_at_current_line(std::string message);
  Next replace_top(std::size_t count, tl::expected<Value, std::string> result);

  void add_cost(const Value & value);
  void add_cost(std::span<const Value> values);

  Next load(const Value & value, const Instruction & instruction);
  Next binary_operator(Operator op);
  template <typename Make>
  Next make_container(std::size_t count, Make make);
  Next jump_if_false(const Instruction & instruction);
  Next jump_or_pop(const Instruction & instruction, bool jump_value);
  Next call(const Instruction & instruction);
  Next call_builtin(const Instruction & instruction);
  /// Of a call of this name: replaces its arguments on the stack by the value, or waits for it.
  Next handle_outcome(const std::string & name, Outcome outcome, std::size_t arguments);
  Next return_value();
  Next return_to_operation();
  /// Ends the current function of the thread.
  Frame pop_frame();
  Next store_lvalue(const Instruction & instruction);
  Next method(const Instruction & instruction);
  Next run_thread(const Instruction & instruction);
  Next kill_or_join(bool join);
  Next exit_critical_section();

  Value & local(std::uint32_t slot) { return thread_->stack[thread_->frames.back().base + slot]; }
  Value & resolve_variable(const Instruction & instruction);
  Value & variable(const Lvalue & lvalue);
  Value pop();
  std::span<Value> top(std::size_t count) { return std::span(thread_->stack).last(count); }
  void drop(std::size_t count) { thread_->stack.resize(thread_->stack.size() - count); }

  const Code * code_;
  const Library & library_;
  const MachineOptions & options_;
  std::vector<Value> globals_;
  std::vector<std::unique_ptr<Thread>> threads_;
  std::int32_t next_handle_ = 1;
  std::int32_t critical_owner_ = 0;
  bool halted_ = false;
  std::optional<RunTimeError> error_;

  Thread * thread_ = nullptr;        ///< the running thread
  CallContext * context_ = nullptr;  ///< of builtins that the running thread calls
  std::uint32_t cost_ = 0;           ///< instructions used by the running thread in this turn
};

}  // namespace ur_simulator::urscript
