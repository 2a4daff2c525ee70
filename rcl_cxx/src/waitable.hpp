#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>

namespace rcl_cxx::detail {
class NodeImpl;

/// Something of a node that has callbacks: its middleware side tells notify() what has arrived, the
/// executor's thread calls serve() for each of them, the user's handle calls close().
///
/// The middleware keeps raw pointers to `sources_`: a class that has registered them takes them back in
/// stop().
class Waitable : public std::enable_shared_from_this<Waitable> {
 public:
  /// As many sources of events as an entity has at most (an action client: five).
  static constexpr std::size_t kSources = 5;

  virtual ~Waitable() = default;
  Waitable(const Waitable &) = delete;
  Waitable & operator=(const Waitable &) = delete;

  /// For messages: "subscription /robot/joint_states".
  const std::string & label() const noexcept { return label_; }
  const std::shared_ptr<NodeImpl> & node() const noexcept { return node_; }

  /// Handles one event. Never throws: what the user's callback throws is logged.
  void serve(std::size_t source) noexcept;

  /// Waits for a callback that runs in another thread, then no further one runs.
  void close() noexcept;

  /// For the executor: something has arrived that was not served yet.
  void notify(std::size_t source, std::size_t count) noexcept;

 protected:
  Waitable(std::shared_ptr<NodeImpl> node, std::string label);

  /// Takes one message (request, …) from `source` and runs its callback; nothing if nothing is there, which
  /// is normal: the middleware counts what has arrived, not what its history has kept.
  virtual void execute(std::size_t source) = 0;
  /// Unregisters from the middleware. In close(), once.
  virtual void stop() noexcept = 0;

  /// What to give to rcl_…_set_on_new_…_callback, with &on_event as the function.
  const void * source(std::size_t index) const noexcept { return &sources_[index]; }
  static void on_event(const void * source, std::size_t count) noexcept;

  bool closed() const noexcept { return closed_; }

 private:
  struct Source {
    Waitable * waitable = nullptr;
    std::atomic<std::size_t> pending{0};
  };

  const std::shared_ptr<NodeImpl> node_;
  const std::string label_;
  std::array<Source, kSources> sources_;
  std::recursive_mutex callback_;  // held while a callback runs; it may close its own entity
  bool closed_ = false;            // guarded by callback_
};

}  // namespace rcl_cxx::detail
