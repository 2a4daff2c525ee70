#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "urscript/library.hpp"
#include "urscript/value.hpp"

namespace ur_simulator::urscript {

/// Stack frame of a call.
struct Frame {
  std::uint32_t function = 0;
  std::uint32_t base = 0;       ///< of its locals on the stack
  std::uint32_t return_to = 0;  ///< instruction of the caller
  /// The operation that called the function, which goes on when it returns; else null.
  std::unique_ptr<PendingCall> caller = nullptr;
};

enum class ThreadState : std::uint8_t {
  ready,
  next_cycle,  ///< the call returns `pending` in the next cycle
  operation,   ///< in a builtin that takes physical time
  joining,     ///< waits for the end of thread `joined_thread`
  ended,
};

/// State of a thread of a program, which can be interrupted at any instruction and continue in a later cycle.
struct Thread {
  std::int32_t handle = 0;
  std::int32_t parent = 0;       ///< handle of the thread that started it
  std::uint32_t started_by = 0;  ///< function that started it
  ThreadState state = ThreadState::ready;
  std::uint32_t next = 0;  ///< instruction
  std::vector<Value> stack;
  std::vector<Frame> frames;
  Value pending;
  std::unique_ptr<PendingCall> operation;
  std::int32_t joined_thread = 0;
  std::uint32_t critical = 0;             ///< nesting depth of critical sections
  std::uint64_t cycles_without_wait = 0;  ///< consecutive cycles in which it used up its share

  void end()
  {
    if (operation) {
      operation->cancel();
      operation.reset();
    }
    for (Frame & frame : frames) {
      if (frame.caller) {
        frame.caller->cancel();
        frame.caller.reset();
      }
    }
    state = ThreadState::ended;
  }
};

}  // namespace ur_simulator::urscript
