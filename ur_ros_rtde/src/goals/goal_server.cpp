#include "ur_ros_rtde/detail/goal_server.hpp"

#include "ur_ros_rtde/detail/goals.hpp"
#include "ur_ros_rtde/detail/guarded.hpp"

namespace ur_ros_rtde {
namespace {

Outcome answer(const std::vector<GoalQuery> & queries, const StopRequest & stop_request)
{
  for (const GoalQuery & query : queries) {
    if (auto why = stop_request.reason()) {
      return *std::move(why);
    }
    if (Status answered = query(); !answered) {
      return answered;
    }
  }
  return Outcome::success();
}

}  // namespace

Error client_lost()
{
  return Error{
      ErrorCode::client_lost,
      "the client that sent this goal has disappeared: keep the action client alive until the result is "
      "received, or start command_server with on_client_lost:=continue"};
}

Outcome missing_result(rcl_cxx::GoalStatus status)
{
  if (status == rcl_cxx::GoalStatus::unknown) {
    return Outcome::failure(ErrorCode::exception,
                            "this driver has no such goal: it has expired, or another driver with the same "
                            "names has accepted it");
  }
  return Outcome::failure(ErrorCode::exception,
                          "the goal ended without a result that can be sent: see the log of the driver");
}

GoalServer::GoalServer(PluginHost & host, const Description & description, MakeGoal make_goal,
                       WriteMissingResult write_missing_result)
    : host_(host), make_goal_(std::move(make_goal)), is_stop_(description.is_stop)
{
  rcl_cxx::ActionServerCallbacks callbacks;
  callbacks.handle_goal = [this](const rcl_cxx::GoalUUID & id, const void * request) {
    return decide(id, request);
  };
  callbacks.handle_accepted = [this](const std::shared_ptr<Handle> & handle) { start(handle); };
  callbacks.handle_cancel = [](Handle &) { return true; };
  callbacks.on_canceling = [this](Handle & handle) {
    stop(handle.get_goal_id(), Error{ErrorCode::canceled, "canceled by a client"});
  };
  callbacks.on_goal_discarded = [this](const rcl_cxx::GoalUUID & id) {
    if (const auto goal = forget(id)) {
      goal->release();
    }
  };
  if (description.on_client_lost) {
    callbacks.on_client_lost = [this, tell_host = description.on_client_lost](Handle & handle) {
      stop(handle.get_goal_id(), client_lost());
      tell_host(handle.get_goal_id());
    };
  }
  callbacks.fill_missing_result = std::move(write_missing_result);
  rcl_cxx::ActionServerOptions options;
  options.cancel_callback_group = host.stop_group();
  options.goal_callback_group = description.is_stop ? host.stop_group() : nullptr;
  options.creation_callback_group =
      description.is_stop ? nullptr : host.creation_group();  // a stop must not wait for its server
  server_ =
      host.node().create_action_server(description.type, description.name, std::move(callbacks), options);
}

rcl_cxx::GoalDecision GoalServer::decide(const rcl_cxx::GoalUUID & id, const void * request)
{
  const auto goal = make_goal_(id, request);
  std::vector<GoalQuery> queries;
  const Outcome checked = guarded([&]() -> Outcome {
    if (is_stop_) {
      return goal->check(queries);  // it has begun to stop the arm, even if the goal cannot be executed
    }
    const Status can_start = host_.goals().can_start();
    return can_start ? goal->check(queries) : can_start;
  });
  if (!checked) {
    return reject(*goal, checked.error());
  }
  {
    const std::lock_guard lock(mutex_);
    goals_[id] = goal;
  }
  if (queries.empty()) {
    return rcl_cxx::GoalResponse();
  }
  return rcl_cxx::DeferredGoalResponse{
      [this, goal, pending = std::move(queries)](const rcl_cxx::SendGoalResponse & respond) {
        start_queries(goal, pending, respond);
      }};
}

void GoalServer::start_queries(const std::shared_ptr<Goal> & goal, std::vector<GoalQuery> queries,
                               const rcl_cxx::SendGoalResponse & respond)
{
  const auto reject_and_forget = [this, goal](const Error & why) {
    forget(goal->id());
    goal->release();
    return reject(*goal, why);
  };
  const Status started = start_work(goal, [goal, pending = std::move(queries), respond, reject_and_forget] {
    const Outcome outcome =
        guarded(goal->stop_request(), [&] { return answer(pending, goal->stop_request()); });
    respond(outcome ? rcl_cxx::GoalResponse() : reject_and_forget(outcome.error()));
  });
  if (!started) {
    respond(reject_and_forget(started.error()));
  }
}

void GoalServer::start(const std::shared_ptr<Handle> & handle)
{
  const auto goal = find(handle->get_goal_id());
  if (!goal) {
    return;  // discarded: without its handle, the goal is aborted
  }
  goal->accept(handle);
  const Status started = start_work(goal, [this, goal] {
    goal->run();
    forget(goal->id());
  });
  if (!started) {
    host_.goals().end(goal, [this, goal, started] {
      goal->end(started);
      forget(goal->id());
    });
  }
}

Status GoalServer::start_work(const std::shared_ptr<Goal> & goal, std::function<void()> work)
{
  return host_.goals().start(goal, std::move(work), is_stop_ ? Goals::Work::stop : Goals::Work::goal);
}

void GoalServer::stop(const rcl_cxx::GoalUUID & id, const Error & why) const
{
  if (const auto goal = find(id)) {
    goal->stop(why);
  }
}

rcl_cxx::GoalResponse GoalServer::reject(const Goal & goal, const Error & why)
{
  host_.publish_rejection(goal.action(), goal.id(), why);
  return tl::make_unexpected(with_code(why));
}

std::shared_ptr<Goal> GoalServer::find(const rcl_cxx::GoalUUID & id) const
{
  const std::lock_guard lock(mutex_);
  const auto found = goals_.find(id);
  return found == goals_.end() ? nullptr : found->second;
}

std::shared_ptr<Goal> GoalServer::forget(const rcl_cxx::GoalUUID & id)
{
  const std::lock_guard lock(mutex_);
  auto node = goals_.extract(id);
  return node ? std::move(node.mapped()) : nullptr;
}

}  // namespace ur_ros_rtde
