#pragma once

#include <rcl/timer.h>
#include <rcl_action/action_server.h>

#include <action_msgs/srv/cancel_goal.hpp>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "rcl_cxx/action_server.hpp"
#include "response_retry.hpp"
#include "server_goal_impl.hpp"
#include "waitable.hpp"

namespace rcl_cxx::detail {
class TimerImpl;

/// The timer that rcl_action wants to be given (Kilted). It never runs: the server sees to the expiry itself,
/// because nothing waits on a wait set here; but rcl_action reads its clock from it.
class ExpireTimer {
 public:
  explicit ExpireTimer(NodeImpl & node);
  ~ExpireTimer();
  ExpireTimer(const ExpireTimer &) = delete;
  ExpireTimer & operator=(const ExpireTimer &) = delete;
  const rcl_timer_t * get() const noexcept { return &timer_; }

 private:
  rcl_timer_t timer_;
};

/// An action server. One lock guards rcl's state and the goals; no handler of the user runs under it.
class ActionServerImpl : public Waitable {
 public:
  static std::shared_ptr<ActionServerImpl> create(std::shared_ptr<NodeImpl> node, ErasedActionServer erased,
                                                  const std::string & name,
                                                  const ActionServerOptions & options);
  ActionServerImpl(std::shared_ptr<NodeImpl> node, ErasedActionServer erased, const std::string & name,
                   const ActionServerOptions & options);
  ~ActionServerImpl() override;

  const std::string & get_action_name() const noexcept { return name_; }
  std::size_t active_goal_count() const;
  /// Aborts what is active, with empty results, and gives clients that were just told of the acceptance of
  /// their goals a moment to ask for the results: here if `serve`, otherwise in the executor's thread.
  void abort_all(const char * why, bool serve) noexcept;
  /// The user's server object is destroyed: after close() and abort_all() nothing reaches a goal any more.
  void retire() noexcept;

  // For goal handles, from any thread.
  bool finish(ServerGoalImpl & goal, GoalStatus status, std::shared_ptr<void> result_response) noexcept;
  bool publish_feedback(const ServerGoalImpl & goal, void * message) noexcept;
  void on_handle_dropped(ServerGoalImpl & goal) noexcept;

 protected:
  void execute(std::size_t source) override;
  void stop() noexcept override;

 private:
  enum Source : std::size_t { kGoal, kCancel, kResult, kDeferredResponse };

  void start();
  void take_goal();
  void take_cancel();
  bool take_result();
  void expire();
  void watch_client(ServerGoalImpl & goal, const rmw_request_id_t & request);
  void check_clients();

  /// A goal request without a response.
  struct DeferredGoal {
    rmw_request_id_t request_id;
    std::shared_ptr<void> request;
    std::optional<GoalResponse> response{};  ///< to be sent by the executor's thread
    bool canceled = false;
  };

  bool is_known(const GoalUUID & id) const;
  GoalDecision decide_goal(const GoalUUID & id, const void * request) noexcept;
  void defer(const GoalUUID & id, DeferredGoal goal, const DeferredGoalResponse & response);
  /// For SendGoalResponse, from any thread.
  void set_response(const GoalUUID & id, GoalResponse response) noexcept;
  void send_deferred_response();
  void respond(const GoalUUID & id, const DeferredGoal & goal, const GoalResponse & response);
  void reject(const GoalUUID & id, const rmw_request_id_t & request_id, const std::string & reason);
  void reject_deferred_goals(const char * reason) noexcept;
  tl::expected<std::shared_ptr<ServerGoalHandleBase>, std::string> accept(
      const GoalUUID & id, const std::shared_ptr<void> & request);
  void run_accepted(std::shared_ptr<ServerGoalHandleBase> handle) noexcept;
  void announce(const rmw_request_id_t & request, std::shared_ptr<ServerGoalHandleBase> accepted);
  void discard(const GoalUUID & id) noexcept;
  void process_cancel(const action_msgs::srv::CancelGoal::Request & request,
                      action_msgs::srv::CancelGoal::Response & response);
  bool decide_cancel(ServerGoalImpl & goal);
  bool ask_cancel(ServerGoalHandleBase & handle) noexcept;
  /// Calls one of the user's handlers; what it throws is logged.
  void call(const char * name, const GoalUUID & id, const std::function<void()> & handler) const noexcept;
  std::shared_ptr<ServerGoalImpl> find(const GoalUUID & id) const;

  using Send = rcl_ret_t (*)(const rcl_action_server_t *, rmw_request_id_t *, void *);
  /// `done` is told whether it was delivered; that may be seconds later. `instead` is sent when the
  /// middleware throws at `response`.
  void answer(Send send, const rmw_request_id_t & request, std::shared_ptr<void> response,
              std::function<void(bool)> done = {}, std::shared_ptr<void> instead = {});
  void send_result(const rmw_request_id_t & request, ServerGoalImpl & goal);
  /// Of a goal that has none, or none that can be sent.
  std::shared_ptr<void> missing_result(GoalStatus status) const;

  void await_requests(const std::vector<std::shared_ptr<ServerGoalImpl>> & goals, bool serve);

  // Under the lock.
  bool finish_locked(ServerGoalImpl & goal, GoalStatus status, std::shared_ptr<void> result_response);
  bool transition_locked(ServerGoalImpl & goal, GoalStatus status);
  void publish_status_locked();
  void schedule_expiry_locked();
  std::vector<std::shared_ptr<ServerGoalHandleBase>> lost_clients_locked(const ServiceClients & known);

  const ErasedActionServer erased_;
  const ActionServerOps & ops_;
  const std::shared_ptr<ResponseRetry> answers_;
  std::string name_;
  bool results_expire_ = true;
  std::chrono::nanoseconds result_timeout_{0};

  mutable std::mutex mutex_;
  std::unique_ptr<ExpireTimer> rcl_timer_;
  rcl_action_server_t server_;
  std::map<GoalUUID, std::shared_ptr<ServerGoalImpl>> goals_;
  std::map<GoalUUID, DeferredGoal> deferred_goals_;
  std::shared_ptr<TimerImpl> expiry_;
  std::shared_ptr<TimerImpl> client_check_;  // runs while clients are watched
  bool retired_ = false;
  std::size_t shutdown_callback_ = 0;
};

}  // namespace rcl_cxx::detail
