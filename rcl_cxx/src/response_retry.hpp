#pragma once

#include <rcl/types.h>

#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>

namespace rcl_cxx::detail {
class NodeImpl;
class TimerImpl;

/// Sends answers once more. A request may be here before the server has discovered the reader of its answer:
/// discovery has two directions. The middleware then waits for 0.1 s and gives up with RCL_RET_TIMEOUT, and
/// the client would wait for ever. Tried again here, for some seconds, one answer at a time, so that the
/// executor serves others in between.
class ResponseRetry : public std::enable_shared_from_this<ResponseRetry> {
 public:
  using Attempt = std::function<rcl_ret_t()>;
  /// Gets what the last attempt returned.
  using Done = std::function<void(rcl_ret_t)>;

  explicit ResponseRetry(std::shared_ptr<NodeImpl> node);
  ~ResponseRetry();
  ResponseRetry(const ResponseRetry &) = delete;
  ResponseRetry & operator=(const ResponseRetry &) = delete;

  /// Attempts now, in this thread, and if need be later, in the executor's. The functions may hold whom they
  /// belong to.
  void send(Attempt attempt, Done done);
  /// Drops what is left. After it nothing runs any more.
  void stop() noexcept;

 private:
  struct Answer {
    Attempt attempt;
    Done done;
    std::chrono::steady_clock::time_point deadline;
  };

  void keep(Answer answer);
  void run();

  const std::shared_ptr<NodeImpl> node_;
  std::mutex mutex_;
  std::deque<Answer> answers_;
  std::shared_ptr<TimerImpl> timer_;
  bool stopped_ = false;
};

}  // namespace rcl_cxx::detail
