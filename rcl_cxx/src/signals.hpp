#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

namespace rcl_cxx::detail {
/// SIGINT and SIGTERM, delivered as calls in an ordinary thread. One per process, shared by all contexts; the
/// previous handlers come back when the last one lets go.
class SignalWatcher {
 public:
  using Callback = std::function<void(int signal)>;

  static std::shared_ptr<SignalWatcher> instance();
  ~SignalWatcher();
  SignalWatcher(const SignalWatcher &) = delete;
  SignalWatcher & operator=(const SignalWatcher &) = delete;

  /// `callback` is told of every signal, in the watcher's thread, and returns soon; also of one that came
  /// before there was any callback.
  std::size_t add(Callback callback);
  /// After it `callback` does not run any more.
  void remove(std::size_t id);

 private:
  SignalWatcher();
  void run();

  int read_end_ = -1;
  int write_end_ = -1;
  std::mutex mutex_;
  std::map<std::size_t, Callback> callbacks_;
  std::size_t next_id_ = 0;
  unsigned char unheard_ = 0;  ///< the last signal that came while there was no callback; 0: none
  std::thread thread_;
};

/// The default action of `signal`, on the whole process.
void take_default_action(int signal);

}  // namespace rcl_cxx::detail
