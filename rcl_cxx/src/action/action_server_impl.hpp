#pragma once

#include <rcl/timer.h>
#include <rcl_action/action_server.h>

#include <action_msgs/srv/cancel_goal.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "action/server_goal_impl.hpp"
#include "executor/waitable.hpp"
#include "rcl_cxx/action_server.hpp"
#include "rcl_support/type_support.hpp"
#include "services/response_sender.hpp"

namespace rcl_cxx::detail {
class TimerImpl;

constexpr const char * kSendGoalName = "send_goal";

/// An action server. A mutex guards the goals and the state of rcl_action. No callback of the user runs under
/// it.
class ActionServerImpl : public Waitable {
 public:
  ActionServerImpl(std::shared_ptr<NodeImpl> node, const ActionType & type, const std::string & name,
                   ActionServerCallbacks callbacks, const ActionServerOptions & options);
  ~ActionServerImpl() override;

  const std::string & get_action_name() const noexcept { return name_; }
  /// Aborts the active goals. Afterwards no goal can be changed.
  void retire() noexcept;

  void set_on_ready_callbacks() override;

  /// One of the three services of an action: the function that sends its responses, and its name.
  struct ServiceOfAction {
    rcl_ret_t (*send)(const rcl_action_server_t *, rmw_request_id_t *, void *);
    const char * name;
  };

  // For goal handles, from any thread.

  /// Returns false and logs if the goal cannot enter this state.
  bool finish(ServerGoalImpl & goal, GoalStatus status, std::shared_ptr<void> result_response) noexcept;
  bool publish_feedback(const ServerGoalImpl & goal, void * message) noexcept;
  void on_handle_dropped(ServerGoalImpl & goal) noexcept;

 protected:
  void execute(std::size_t source) override;
  const CallbackGroup & group(std::size_t source) const override;
  void clear_on_ready_callbacks() noexcept override;

 private:
  enum Source : std::size_t { kGoal, kCancel, kResult, kDeferredResponse };
  using Goals = std::vector<std::shared_ptr<ServerGoalImpl>>;

  struct GoalRequest {
    rmw_request_id_t id;
    std::shared_ptr<void> message;
    std::uint64_t cancels_before;  ///< cancels_of_all_ when it was taken
  };

  /// A goal request whose response is sent later.
  struct DeferredGoal {
    GoalRequest request;
    std::optional<GoalResponse> response{};  ///< to be sent by the executor's thread
  };

  std::shared_ptr<ServerGoalImpl> find(const GoalUUID & id) const;
  Goals get_active_goals() const;
  /// Runs a callback of the user. An exception is logged.
  void call(const char * name, const GoalUUID & id, const std::function<void()> & callback) const noexcept;

  // Requests of clients, in the executor's thread.
  void take_goal();
  std::uint64_t cancels_of_all() const;
  bool is_known(const GoalUUID & id) const;
  GoalDecision handle_goal(const GoalUUID & id, const void * request) noexcept;
  void send_decision(const GoalUUID & id, const GoalRequest & request, const GoalResponse & response);
  void reject(const GoalUUID & id, const rmw_request_id_t & request_id, const std::string & reason);
  tl::expected<std::shared_ptr<ServerGoalHandle>, std::string> accept(const GoalUUID & id,
                                                                      const GoalRequest & request);
  void send_acceptance(const rmw_request_id_t & request, std::shared_ptr<ServerGoalHandle> handle);
  void run_accepted(const std::shared_ptr<ServerGoalHandle> & handle) noexcept;
  void discard(const GoalUUID & id) noexcept;
  void take_cancel();
  void process_cancel(const action_msgs::srv::CancelGoal::Request & request,
                      action_msgs::srv::CancelGoal::Response & response);
  bool try_to_cancel(ServerGoalImpl & goal);
  bool take_result();
  /// `replacement` is made if the response cannot be serialized. `done` receives whether the response was
  /// delivered; that may be seconds later.
  void respond(const ServiceOfAction & service, const rmw_request_id_t & request,
               std::shared_ptr<void> response, std::function<std::shared_ptr<void>()> replacement = {},
               std::function<void(bool)> done = {});

  // Goal requests with a deferred response.
  void defer(const GoalUUID & id, GoalRequest request, const DeferredGoalResponse & response);
  /// For SendGoalResponse, from any thread.
  void set_response(const GoalUUID & id, GoalResponse response) noexcept;
  void send_deferred_response();
  void reject_deferred_goals(const char * reason) noexcept;

  // The end of goals.
  bool try_to_finish(ServerGoalImpl & goal, GoalStatus status, std::shared_ptr<void> result_response);
  bool transition_locked(ServerGoalImpl & goal, GoalStatus status);
  void abort(ServerGoalImpl & goal) noexcept;
  /// Aborts the active goals. Clients whose goals have just been accepted have a moment to request
  /// the results. Takes their requests in this thread if `take_requests`.
  void abort_all(const char * reason, bool take_requests) noexcept;
  bool expects_result_requests() const;
  void wait_for_result_requests(bool take_requests);
  void send_result(const rmw_request_id_t & request, ServerGoalImpl & goal);
  /// The result of a goal that has none, or none that can be sent.
  std::shared_ptr<void> make_empty_result(const GoalUUID & id, GoalStatus status) const;
  void publish_status_locked();
  void expire_goals();
  void schedule_expiry_locked();

  // Clients, in the executor's thread.
  std::string service_name(const char * service) const;
  void watch_client(const std::shared_ptr<ServerGoalImpl> & goal, const rmw_request_id_t & request);
  /// Without any, their checks end until the next goal.
  Goals get_watched_goals();
  void check_clients();

  const ActionType & type_;
  const ActionTypeSupport type_support_;
  const ActionServerCallbacks callbacks_;
  const CallbackGroup::SharedPtr goal_group_;
  const CallbackGroup::SharedPtr cancel_group_;
  const std::shared_ptr<ResponseSender> sender_;
  std::string name_;
  std::chrono::nanoseconds result_timeout_{0};

  mutable std::mutex mutex_;
  rcl_timer_t rcl_timer_ = rcl_get_zero_initialized_timer();  // rcl_action reads its clock; it never runs
  rcl_action_server_t server_ = rcl_action_get_zero_initialized_server();
  std::map<GoalUUID, std::shared_ptr<ServerGoalImpl>> goals_;
  std::map<GoalUUID, DeferredGoal> deferred_goals_;
  std::uint64_t cancels_of_all_ = 0;  // requests to cancel all goals
  Goals watched_goals_;               // those whose client is watched, which may outlast goals_
  std::shared_ptr<TimerImpl> expiry_timer_;
  std::shared_ptr<TimerImpl> client_timer_;  // runs while clients are watched
  bool retired_ = false;
  std::size_t shutdown_callback_ = 0;
};

}  // namespace rcl_cxx::detail
