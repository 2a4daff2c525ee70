#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

namespace rcl_cxx::detail {
/// Delivers SIGINT, SIGTERM and SIGHUP as calls in an ordinary thread. There is one per process, shared by
/// all contexts. The previous handlers are restored with its destruction.
class SignalWatcher {
 public:
  using Callback = std::function<void(int signal)>;

  static std::shared_ptr<SignalWatcher> instance();
  ~SignalWatcher();
  SignalWatcher(const SignalWatcher &) = delete;
  SignalWatcher & operator=(const SignalWatcher &) = delete;

  /// Calls `callback` for every signal, in the watcher's thread; it must return soon. A signal that arrived
  /// before there was a callback is delivered, too.
  std::size_t add(Callback callback);
  /// The callback does not run afterwards.
  void remove(std::size_t id);

 private:
  SignalWatcher();
  void run();

  int read_end_ = -1;
  int write_end_ = -1;
  std::mutex mutex_;
  std::map<std::size_t, Callback> callbacks_;
  std::size_t next_id_ = 0;
  unsigned char undelivered_ = 0;  ///< the last signal without a callback; 0: none
  std::thread thread_;
};

/// Performs the default action of `signal` on the process.
void take_default_action(int signal);

}  // namespace rcl_cxx::detail
