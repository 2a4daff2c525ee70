#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <rcl_cxx/node.hpp>
#include <string>

#include "ur_ros_rtde/detail/goal.hpp"
#include "ur_ros_rtde/detail/guarded.hpp"
#include "ur_ros_rtde/plugin_host.hpp"

namespace ur_ros_rtde {

/// The action server of a command: makes a Goal of each request, passes on what its client and the middleware
/// say of it, and executes it in a thread of its own.
class GoalServer {
 public:
  struct Description {
    const rcl_cxx::ActionType & type;
    std::string name;  ///< of the action, relative
    /// Called when the client of a goal disappears; then the goal is told to end. Empty: it goes on.
    std::function<void(const rcl_cxx::GoalUUID &)> on_client_lost;
    /// The requests are served by the thread that serves cancel requests and runs no other code of plugins.
    bool is_stop = false;
  };
  /// `request`: an A::Goal of the action, which outlives the goal.
  using MakeGoal = std::function<std::shared_ptr<Goal>(const rcl_cxx::GoalUUID & id, const void * request)>;
  /// Writes the A::Result of a goal without a result that can be sent. Called by the thread that serves
  /// stops: must not call a plugin.
  using WriteMissingResult = std::function<void(rcl_cxx::GoalStatus status, void * result)>;

  GoalServer(PluginHost & host, const Description & description, MakeGoal make_goal,
             WriteMissingResult write_missing_result);
  GoalServer(const GoalServer &) = delete;
  GoalServer & operator=(const GoalServer &) = delete;

 private:
  using Handle = rcl_cxx::ServerGoalHandle;

  rcl_cxx::GoalDecision decide(const rcl_cxx::GoalUUID & id, const void * request);
  void start_queries(const std::shared_ptr<Goal> & goal, std::vector<GoalQuery> queries,
                     const rcl_cxx::SendGoalResponse & respond);
  void start(const std::shared_ptr<Handle> & handle);
  Status start_work(const std::shared_ptr<Goal> & goal, std::function<void()> work);
  void stop(const rcl_cxx::GoalUUID & id, const Error & why) const;
  rcl_cxx::GoalResponse reject(const Goal & goal, const Error & why);
  std::shared_ptr<Goal> find(const rcl_cxx::GoalUUID & id) const;
  std::shared_ptr<Goal> forget(const rcl_cxx::GoalUUID & id);

  PluginHost & host_;
  const MakeGoal make_goal_;
  const bool is_stop_;
  mutable std::mutex mutex_;
  std::map<rcl_cxx::GoalUUID, std::shared_ptr<Goal>> goals_;
  rcl_cxx::ActionServer::SharedPtr server_;  ///< last: it calls the rest
};

/// The reason for stopping a goal whose client has disappeared.
Error client_lost();

/// The outcome of a goal without a result, or whose result cannot be sent. Always has an error code.
Outcome missing_result(rcl_cxx::GoalStatus status);

/// Lets `command` write the outcome of a goal into its result. Returns the outcome that was written: an
/// exception of the command is one.
template <typename C, typename Result>
Outcome write_outcome(const C & command, const Outcome & outcome, Result & result)
{
  Outcome actual = guarded([&] {
    command.fill_result(outcome, result);
    return outcome;
  });
  if (actual.code() == ErrorCode::exception) {
    write_standard_fields(actual, result);
  }
  return actual;
}

/// Asks `command` once for the results of all goals that have none.
template <typename C>
GoalServer::WriteMissingResult make_missing_results(const C & command)
{
  using Result = typename C::Result;
  const auto make = [&](rcl_cxx::GoalStatus status) {
    Result result;
    write_outcome(command, missing_result(status), result);
    return result;
  };
  return [unknown = make(rcl_cxx::GoalStatus::unknown), known = make(rcl_cxx::GoalStatus::aborted)](
             rcl_cxx::GoalStatus status, void * result) {
    *static_cast<Result *>(result) = status == rcl_cxx::GoalStatus::unknown ? unknown : known;
  };
}

}  // namespace ur_ros_rtde
