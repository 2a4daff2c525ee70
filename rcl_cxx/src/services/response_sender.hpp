#pragma once

#include <rcl/types.h>

#include <chrono>
#include <functional>
#include <list>
#include <memory>
#include <mutex>

#include "rcl_cxx/callback_group.hpp"
#include "services/service_clients.hpp"

namespace rcl_cxx::detail {
class NodeImpl;
class TimerImpl;

/// Sends the responses of a service. A request may arrive before the server has discovered the reader of the
/// response. The middleware then waits for 0.1 s and returns RCL_RET_TIMEOUT, and the client would never
/// receive its response. This class sends the response when the reader has been discovered, and gives up only
/// when the client is gone: a busy host may need any time for the discovery. Meanwhile the executor executes
/// other callbacks.
class ResponseSender : public std::enable_shared_from_this<ResponseSender> {
 public:
  using Clock = std::chrono::steady_clock;
  using Send = std::function<rcl_ret_t()>;
  struct Response {
    Send send;
    /// Replaces `send` if the response cannot be serialized. Optional.
    Send send_replacement;
    /// Called before the response is sent again.
    std::function<ClientDiscovery()> client;
    /// Called with the last return code: RCL_RET_TIMEOUT if the client is gone. rcl's error state is set
    /// unless the code is RCL_RET_OK.
    std::function<void(rcl_ret_t)> done;
  };

  /// `group`: in whose thread responses are sent again.
  ResponseSender(std::shared_ptr<NodeImpl> node, CallbackGroup::SharedPtr group)
      : node_(std::move(node)), group_(std::move(group))
  {
  }
  ~ResponseSender() { stop(); }
  ResponseSender(const ResponseSender &) = delete;
  ResponseSender & operator=(const ResponseSender &) = delete;

  /// Sends in this thread, and if necessary later in the executor's thread. The functions may hold a
  /// reference to the owner of this object.
  void send(Response response);
  /// Drops the responses that have not been sent. No function of theirs runs afterwards.
  void stop() noexcept;

 private:
  struct Pending {
    Response response;
    Clock::duration pause;   ///< after the next attempt, which may block the executor for 0.1 s
    Clock::time_point next;  ///< no attempt before
  };

  /// This is the thread of a group of its own, whose callbacks are not to be delayed. The check of the client
  /// costs more than most responses.
  bool must_not_block() const;
  void try_to_send(Pending pending);
  void keep(Pending pending);
  void check_clients();
  bool is_stopped();

  const std::shared_ptr<NodeImpl> node_;
  const CallbackGroup::SharedPtr group_;
  std::mutex mutex_;
  std::list<Pending> pending_;
  std::shared_ptr<TimerImpl> timer_;
  bool stopped_ = false;
};

}  // namespace rcl_cxx::detail
