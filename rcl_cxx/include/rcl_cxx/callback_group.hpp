#pragma once

#include <memory>

namespace rcl_cxx {
namespace detail {
class PendingEvents;
}

/// Callbacks that one executor runs, in one thread. Each node has a default group, which Executor::add_node()
/// adds to an executor. The callbacks of a further group (Node::create_callback_group) run in the thread of
/// another executor, so that they do not wait for those of the default group. Events that arrive before the
/// group has an executor are kept.
class CallbackGroup {
 public:
  using SharedPtr = std::shared_ptr<CallbackGroup>;

  CallbackGroup();
  ~CallbackGroup();
  CallbackGroup(const CallbackGroup &) = delete;
  CallbackGroup & operator=(const CallbackGroup &) = delete;

  detail::PendingEvents & pending_events() const noexcept { return *pending_events_; }

 private:
  const std::unique_ptr<detail::PendingEvents> pending_events_;
};

}  // namespace rcl_cxx
