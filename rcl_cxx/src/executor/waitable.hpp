#pragma once

#include <rcl/types.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>

#include "rcl_cxx/callback_group.hpp"
#include "rcl_support/rcl_error.hpp"

namespace rcl_cxx::detail {
class NodeImpl;

/// A part of a node that has callbacks: subscription, service, timer, … The middleware reports new data to
/// on_ready(), the thread of the executor calls take_and_execute() for each, the user's handle calls close().
/// Sources of different callback groups may be executed at the same time.
///
/// The middleware keeps raw pointers to `sources_`, until clear_on_ready_callbacks().
class Waitable : public std::enable_shared_from_this<Waitable> {
 public:
  virtual ~Waitable() = default;
  Waitable(const Waitable &) = delete;
  Waitable & operator=(const Waitable &) = delete;

  /// For log messages: "subscription /robot/joint_states".
  const std::string & label() const noexcept { return label_; }
  const std::shared_ptr<NodeImpl> & node() const noexcept { return node_; }

  /// Handles one event of `source`. An exception that leaves the user's callback is logged.
  void take_and_execute(std::size_t source) noexcept;

  /// Waits for a callback that runs in another thread. No callback runs afterwards.
  void close() noexcept;

  virtual void set_on_ready_callbacks() = 0;

 protected:
  Waitable(std::shared_ptr<NodeImpl> node, std::string label);

  /// The group of a source. By default that of the node.
  virtual const CallbackGroup & group(std::size_t source) const;

  /// Takes one message or request from `source` and runs its callback. There may be nothing to take: the
  /// middleware counts what has arrived, not what its history has kept.
  virtual void execute(std::size_t source) = 0;
  virtual void clear_on_ready_callbacks() noexcept = 0;

  /// Adds an event of `source` that does not come from the middleware. Thread-safe.
  void notify(std::size_t source) noexcept { on_ready(&sources_[source], 1); }

  /// `set` is one of the functions rcl_…_set_on_new_…_callback.
  template <typename Set, typename Handle>
  void set_callback(Set set, Handle & handle, std::size_t source)
  {
    check_rcl(set(&handle, &on_ready, &sources_[source]), label_, "the middleware does not report new data");
  }
  template <typename Set, typename Handle>
  static void clear_callback(Set set, Handle & handle) noexcept
  {
    ignore_rcl(set(&handle, nullptr, nullptr));
  }

 private:
  struct Source {
    Waitable * waitable = nullptr;
    mutable std::atomic<std::size_t> pending{0};  // the middleware has a pointer to a constant source
    std::recursive_mutex callback;                // held while a callback runs; the callback may call close()
  };

  static void on_ready(const void * source, std::size_t count) noexcept;
  void push_event(std::size_t source) noexcept;

  const std::shared_ptr<NodeImpl> node_;
  const std::string label_;
  std::array<Source, 5> sources_;  // an action client has five
  bool closed_ = false;            // written with all of their mutexes, read with one of them
};

template <typename T, typename... Arguments>
std::shared_ptr<T> make_waitable(Arguments &&... arguments)
{
  auto waitable = std::make_shared<T>(std::forward<Arguments>(arguments)...);
  static_cast<Waitable &>(*waitable).set_on_ready_callbacks();
  return waitable;
}

}  // namespace rcl_cxx::detail
