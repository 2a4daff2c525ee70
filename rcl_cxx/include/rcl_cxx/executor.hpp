#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "rcl_cxx/context.hpp"

namespace rcl_cxx {
class Node;

namespace detail {
class EventQueue;
class NodeImpl;
}  // namespace detail

/// Runs the callbacks of its nodes, one at a time, in the thread that spins. Event-driven: the middleware
/// pushes what has arrived into a queue; no wait set exists.
///
/// Entities may be created and destroyed at any time, from any thread and from callbacks. An exception that
/// leaves a callback is logged with the entity's name; the rest goes on. Long work belongs in a thread of its
/// own.
class Executor {
 public:
  explicit Executor(Context::SharedPtr context);
  /// Nodes are released; what happened to them meanwhile waits for the next executor that they are added to.
  ~Executor();
  Executor(const Executor &) = delete;
  Executor & operator=(const Executor &) = delete;

  /// @throws Error if the node is in another executor.
  void add_node(const Node & node);
  void add_node(const std::shared_ptr<Node> & node);
  void remove_node(const Node & node);

  /// Until cancel() or the end of the context's shutdown. @throws Error if a thread is spinning already.
  void spin();
  void spin_for(std::chrono::nanoseconds duration);
  /// Until `condition` holds (looked at after every callback, and every 10 ms), or `timeout`. Returns whether
  /// it holds at the end.
  bool spin_until(const std::function<bool()> & condition, std::chrono::nanoseconds timeout);

  /// Ends a spin after the callback that is running. Without one, the next spin returns at once: a cancel is
  /// not lost to a thread that has yet to start spinning.
  void cancel();

  /// Runs `task` in the spinning thread, after what is queued already. From any thread.
  void post(std::function<void()> task);

  /// True in a callback of this executor.
  bool in_callback_thread() const noexcept;

 private:
  class Spinning;

  Context::SharedPtr context_;
  std::shared_ptr<detail::EventQueue> queue_;
  std::size_t end_callback_ = 0;
  std::mutex nodes_mutex_;
  std::vector<std::weak_ptr<detail::NodeImpl>> nodes_;
  std::atomic<bool> spinning_{false};
};

}  // namespace rcl_cxx
