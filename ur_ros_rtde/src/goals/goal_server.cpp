#include "ur_ros_rtde/detail/goal_server.hpp"

#include "ur_ros_rtde/detail/guarded.hpp"

namespace ur_ros_rtde {

void GoalServer::start_server(rcl_cxx::Node & node, const rcl_cxx::ActionType & type,
                              const std::string & name, ActiveGoals & goals, bool stop_when_client_lost)
{
  goals_ = &goals;
  rcl_cxx::ActionServerCallbacks callbacks;
  callbacks.handle_goal = [this](const rcl_cxx::GoalUUID & id, const void * goal) {
    return accept_goal(id, goal);
  };
  callbacks.handle_accepted = [this](const std::shared_ptr<Handle> & handle) { start_goal(handle); };
  callbacks.handle_cancel = [](Handle &) { return true; };
  callbacks.on_canceling = [this](Handle & handle) {
    goals_->stop(handle.get_goal_id(), Error{ErrorCode::canceled, "canceled by a client"});
  };
  callbacks.on_goal_discarded = [this](const rcl_cxx::GoalUUID & id) { goals_->discard(id); };
  if (stop_when_client_lost) {
    callbacks.on_client_lost = [this](Handle & handle) { goals_->stop(handle.get_goal_id(), client_lost()); };
  }
  callbacks.fill_missing_result = [this](rcl_cxx::GoalStatus status, void * result) {
    write_outcome_guarded(missing_result(status), result);
  };
  server_ = node.create_action_server(type, name, std::move(callbacks));
}

void GoalServer::start_goal(const std::shared_ptr<Handle> & handle)
{
  const Status started = goals_->start(
      handle->get_goal_id(),
      [this, handle](const std::shared_ptr<GoalContext> & context) { execute_goal(*handle, *context); });
  if (!started) {
    abort_unstarted(*handle, started);
  }
}

Outcome GoalServer::write_outcome_guarded(const Outcome & outcome, void * result) const
{
  bool written = false;
  const Outcome actual = guarded([&] {
    write_outcome(outcome, result);
    written = true;
    return outcome;
  });
  if (!written) {
    write_failure(actual, result);
  }
  return actual;
}

void GoalServer::finish(Handle & handle, void * result, const Outcome & outcome)
{
  const Outcome actual = write_outcome_guarded(outcome, result);
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
