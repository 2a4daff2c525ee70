#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "event_queue.hpp"

namespace rcl_cxx::detail {
/// Where the events of a node's entities go: into the queue of the executor that it was added to; until there
/// is one they wait here.
class PendingEvents {
 public:
  void push(Event event);
  /// A timer is due at some time; of no effect until there is a queue: attach() arms all timers.
  void schedule(TimedEvent event);
  void add_timer(std::weak_ptr<TimerImpl> timer);

  /// False if there is one already.
  bool attach(std::shared_ptr<EventQueue> queue);
  /// Only from `queue`.
  void detach(EventQueue & queue);
  std::shared_ptr<EventQueue> queue() const;

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<EventQueue> queue_;
  std::vector<Event> waiting_;
  std::vector<std::weak_ptr<TimerImpl>> timers_;
};

}  // namespace rcl_cxx::detail
