#pragma once

#include <rcl/context.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <thread>
#include <vector>

#include "context/signals.hpp"
#include "rcl_cxx/context.hpp"

namespace rcl_cxx::detail {
/// Owns the rcl context. Lives as long as any node of it.
class ContextImpl : public std::enable_shared_from_this<ContextImpl> {
 public:
  /// The phases of a shutdown, in their order. The callbacks of a phase run in order of registration.
  /// pre_shutdown: callbacks of the user, communication works. action_servers: abort the remaining goals.
  /// rosout: ends /rosout. on_shutdown: rcl is shut down.
  enum class Phase { pre_shutdown, action_servers, rosout, on_shutdown };

  ContextImpl(const std::vector<std::string> & arguments, const InitOptions & options);
  ~ContextImpl();
  ContextImpl(const ContextImpl &) = delete;
  ContextImpl & operator=(const ContextImpl &) = delete;

  /// Not in the constructor: it needs shared_from_this().
  void watch_signals();
  /// The thread that shuts down after a signal holds a reference to this object.
  void join_signal_thread();

  bool ok() const noexcept { return state_.load() == State::running; }
  bool shutdown(const std::string & reason);
  std::string shutdown_reason() const;
  bool wait_for(std::chrono::nanoseconds timeout, bool complete) const;

  std::size_t add_callback(Phase phase, Context::Callback callback);
  void remove_callback(std::size_t id);

  rcl_context_t * handle() noexcept { return &context_; }
  /// To hold while an entity is created: rcl is not shut down in the meantime.
  std::shared_mutex & creation_mutex() noexcept { return creation_mutex_; }
  const std::vector<std::string> & non_ros_arguments() const noexcept { return non_ros_arguments_; }

 private:
  enum class State { running, shutting_down, shut_down };
  using Key = std::pair<Phase, std::size_t>;

  void init(const std::vector<const char *> & argv);
  void on_signal(int signal);
  void run_callbacks(Phase phase);
  void run_callback(const Context::Callback & callback) noexcept;
  void set_state(State state);

  rcl_context_t context_ = rcl_get_zero_initialized_context();
  std::vector<std::string> non_ros_arguments_;
  std::shared_ptr<void> logging_;
  const std::chrono::milliseconds signal_grace_;

  std::atomic<State> state_{State::running};
  std::shared_mutex creation_mutex_;
  mutable std::mutex mutex_;  // guards what follows
  mutable std::condition_variable state_changed_;
  std::string reason_;
  std::map<Key, Context::Callback> callbacks_;
  Phase reached_ = Phase::pre_shutdown;
  std::size_t next_id_ = 0;
  std::recursive_mutex running_callback_;  // held while a callback runs: remove_callback() waits for it

  std::shared_ptr<SignalWatcher> signals_;
  std::size_t signal_id_ = 0;
  std::optional<std::chrono::steady_clock::time_point> first_signal_;
  std::thread signal_thread_;
};

}  // namespace rcl_cxx::detail
