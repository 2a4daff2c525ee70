#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <rcl_cxx/node.hpp>
#include <string>

#include "ur_ros_rtde/detail/goal.hpp"
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
  /// Writes the outcome of a goal without a result that can be sent into an A::Result. May throw.
  using WriteOutcome = std::function<void(const Outcome & outcome, void * result)>;

  GoalServer(PluginHost & host, const Description & description, MakeGoal make_goal,
             WriteOutcome write_outcome);
  GoalServer(const GoalServer &) = delete;
  GoalServer & operator=(const GoalServer &) = delete;

 private:
  using Handle = rcl_cxx::ServerGoalHandle;

  rcl_cxx::GoalDecision decide(const rcl_cxx::GoalUUID & id, const void * request);
  void start_queries(const std::shared_ptr<Goal> & goal, std::vector<GoalQuery> queries,
                     const rcl_cxx::SendGoalResponse & respond);
  void start(const std::shared_ptr<Handle> & handle);
  void stop(const rcl_cxx::GoalUUID & id, const Error & why) const;
  rcl_cxx::GoalResponse reject(const Goal & goal, const Error & why);
  std::shared_ptr<Goal> find(const rcl_cxx::GoalUUID & id) const;
  std::shared_ptr<Goal> forget(const rcl_cxx::GoalUUID & id);

  PluginHost & host_;
  const MakeGoal make_goal_;
  mutable std::mutex mutex_;
  std::map<rcl_cxx::GoalUUID, std::shared_ptr<Goal>> goals_;
  rcl_cxx::ActionServer::SharedPtr server_;  ///< last: it calls the rest
};

/// The reason for stopping a goal whose client has disappeared.
Error client_lost();

}  // namespace ur_ros_rtde
