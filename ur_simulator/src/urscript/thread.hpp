#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "urscript/library.hpp"
#include "urscript/value.hpp"

namespace ur_simulator::urscript {

/// One call that has not returned.
struct Frame {
  std::uint32_t function = 0;
  std::uint32_t base = 0;       ///< of its locals on the stack
  std::uint32_t return_to = 0;  ///< instruction of the caller
};

enum class ThreadState : std::uint8_t {
  ready,
  next_cycle,  ///< `pending` is the value of the call, from the next cycle on
  operation,   ///< in a builtin that takes time
  joining,     ///< until thread `awaited` ends
  ended,
};

/// A thread of a program: everything it needs to stop anywhere and go on in a later cycle.
struct Thread {
  std::int32_t handle = 0;
  ThreadState state = ThreadState::ready;
  std::uint32_t next = 0;  ///< instruction
  std::vector<Value> stack;
  std::vector<Frame> frames;
  Value pending;
  std::unique_ptr<Operation> operation;
  std::int32_t awaited = 0;
  std::uint32_t critical = 0;   ///< how many critical sections it is in
  std::uint64_t computing = 0;  ///< cycles in a row in which it used all its share

  void abandon()
  {
    if (operation) {
      operation->abandon();
      operation.reset();
    }
    state = ThreadState::ended;
  }
};

}  // namespace ur_simulator::urscript
