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

/// Sends the responses of a service. A request may arrive before the server has discovered the reader of the
/// response. The middleware then waits for 0.1 s and returns RCL_RET_TIMEOUT, and the client would never
/// receive its response. This class tries again for 5 s, one response at a time, so that the executor can
/// execute other callbacks in between.
class ResponseSender : public std::enable_shared_from_this<ResponseSender> {
 public:
  using Send = std::function<rcl_ret_t()>;
  struct Response {
    Send send;
    /// Replaces `send` if the response cannot be serialized. Optional.
    Send send_replacement;
    /// Called with the last return code. rcl's error state is set unless the code is RCL_RET_OK.
    std::function<void(rcl_ret_t)> done;
    std::chrono::steady_clock::time_point deadline{};
  };

  explicit ResponseSender(std::shared_ptr<NodeImpl> node) : node_(std::move(node)) {}
  ~ResponseSender() { stop(); }
  ResponseSender(const ResponseSender &) = delete;
  ResponseSender & operator=(const ResponseSender &) = delete;

  /// Sends in this thread, and if necessary later in the executor's thread. The functions may hold a
  /// reference to the owner of this object.
  void send(Response response);
  /// Drops the responses that have not been sent. No function of theirs runs afterwards.
  void stop() noexcept;

 private:
  void try_to_send(Response response);
  void send_next();

  const std::shared_ptr<NodeImpl> node_;
  std::mutex mutex_;
  std::deque<Response> responses_;
  std::shared_ptr<TimerImpl> timer_;
  bool stopped_ = false;
};

}  // namespace rcl_cxx::detail
