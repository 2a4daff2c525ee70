#pragma once

#include <memory>
#include <rcl_cxx/node.hpp>
#include <string>
#include <utility>

#include "ur_ros_rtde/detail/active_goals.hpp"
#include "ur_ros_rtde/detail/guarded.hpp"

namespace ur_ros_rtde {

/// The part of Command<A> and DashboardCommand<A> that depends on the type of the action: an action server
/// that executes each accepted goal in a thread of its own and sends exactly one result. The result of `A`
/// begins with `bool success, uint16 error_code, string message`.
template <typename A>
class GoalServer {
 protected:
  using Handle = rcl_cxx::ServerGoalHandle<A>;

  GoalServer() = default;
  virtual ~GoalServer() = default;

  /// Runs in the executor's thread and must not wait.
  virtual rcl_cxx::GoalDecision accept_goal(const rcl_cxx::GoalUUID & id, const typename A::Goal & goal) = 0;
  /// Runs in the goal's thread and ends with finish().
  virtual void execute_goal(Handle & handle, GoalContext & context) = 0;
  /// Called for an accepted goal for which no thread could be started. Ends with finish().
  virtual void abort_unstarted(Handle & handle, const Outcome & outcome) = 0;
  /// Writes the outcome into the result. Override it for results that begin with other fields.
  virtual void fill_result(const Outcome & outcome, typename A::Result & result) const
  {
    if constexpr (requires { result.success; }) {
      result.success = static_cast<bool>(outcome);
      result.error_code = static_cast<std::uint16_t>(outcome.code());
      result.message = outcome.message();
    }
  }

  /// `goals` outlives the server. If `stop_when_client_lost`, a goal is stopped when the client that sent it
  /// disappears.
  void start_server(rcl_cxx::Node & node, const std::string & name, ActiveGoals & goals,
                    bool stop_when_client_lost);
  void stop_server() { server_.reset(); }
  /// Sends the goal's only result, with the outcome filled in.
  void finish(Handle & handle, typename A::Result & result, const Outcome & outcome);

 private:
  /// fill_result(). If it throws, the exception is the outcome.
  Outcome fill_result_guarded(const Outcome & outcome, typename A::Result & result) const;

  ActiveGoals * goals_ = nullptr;
  typename rcl_cxx::ActionServer<A>::SharedPtr server_;
};

template <typename A>
void GoalServer<A>::start_server(rcl_cxx::Node & node, const std::string & name, ActiveGoals & goals,
                                 bool stop_when_client_lost)
{
  goals_ = &goals;
  rcl_cxx::ActionServerCallbacks<A> handlers;
  handlers.handle_goal = [this](const rcl_cxx::GoalUUID & id, const typename A::Goal & goal) {
    return accept_goal(id, goal);
  };
  handlers.handle_accepted = [this](std::shared_ptr<Handle> handle) {
    const Status started = goals_->start(
        handle->get_goal_id(),
        [this, handle](std::shared_ptr<GoalContext> context) { execute_goal(*handle, *context); });
    if (!started) {
      abort_unstarted(*handle, started);
    }
  };
  handlers.handle_cancel = [](Handle &) { return true; };
  handlers.on_canceling = [this](Handle & handle) {
    goals_->stop(handle.get_goal_id(), Error{ErrorCode::canceled, "canceled by a client"});
  };
  handlers.on_goal_discarded = [this](const rcl_cxx::GoalUUID & id) { goals_->discard(id); };
  if (stop_when_client_lost) {
    handlers.on_client_lost = [this](Handle & handle) { goals_->stop(handle.get_goal_id(), client_lost()); };
  }
  handlers.fill_missing_result = [this](rcl_cxx::GoalStatus status, typename A::Result & result) {
    fill_result_guarded(missing_result(status), result);
  };
  server_ = node.template create_action_server<A>(name, std::move(handlers));
}

template <typename A>
Outcome GoalServer<A>::fill_result_guarded(const Outcome & outcome, typename A::Result & result) const
{
  bool filled = false;
  const Outcome actual = guarded([&] {
    fill_result(outcome, result);
    filled = true;
    return outcome;
  });
  if (!filled) {
    GoalServer<A>::fill_result(actual, result);
  }
  return actual;
}

template <typename A>
void GoalServer<A>::finish(Handle & handle, typename A::Result & result, const Outcome & outcome)
{
  const Outcome actual = fill_result_guarded(outcome, result);
  goals_->finish(handle.get_goal_id(), actual);
  if (actual) {
    handle.succeed(result);
  } else if (actual.code() == ErrorCode::canceled && handle.is_canceling()) {
    handle.canceled(result);
  } else {
    handle.abort(result);
  }
}

}  // namespace ur_ros_rtde
