#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>

#include "rcl_cxx/callback_group.hpp"
#include "rcl_cxx/context.hpp"

namespace rcl_cxx {
class Node;

namespace detail {
class EventQueue;
}

/// A single-threaded, event-driven executor: the middleware pushes new data into a queue, there is no wait
/// set. Callbacks run one at a time in the thread that spins.
///
/// Publishers, subscriptions, timers, … may be created and destroyed at any time, from any thread and from
/// callbacks. An exception that leaves a callback is logged. Long work belongs in a thread of its own.
class Executor {
 public:
  explicit Executor(Context::SharedPtr context);
  ~Executor();
  Executor(const Executor &) = delete;
  Executor & operator=(const Executor &) = delete;

  /// The default callback group of a node belongs to one executor for its lifetime. @throws Error if the node
  /// has an executor already.
  void add_node(const Node & node);
  void add_node(const std::shared_ptr<Node> & node) { add_node(*node); }
  /// For a group made by Node::create_callback_group(). @throws Error if it has an executor already.
  void add_callback_group(const CallbackGroup & group);

  /// Runs callbacks until cancel() or the end of the context's shutdown. @throws Error if a thread is
  /// spinning already.
  void spin();
  /// Runs callbacks until `condition` holds. Checks the condition after every callback, and every 10 ms.
  /// Returns its last value: false on timeout, cancel() and shutdown.
  bool spin_until(const std::function<bool()> & condition, std::chrono::nanoseconds timeout);

  /// Makes a spin return after the current callback. If no thread spins, the next spin returns at once.
  void cancel();

  /// Runs `task` in the spinning thread, after the events that are already queued. Callable from any thread.
  void post(std::function<void()> task);

 private:
  class Spinning;

  Context::SharedPtr context_;
  std::shared_ptr<detail::EventQueue> queue_;
  std::size_t shutdown_callback_ = 0;
  std::atomic<bool> spinning_{false};
};

}  // namespace rcl_cxx
