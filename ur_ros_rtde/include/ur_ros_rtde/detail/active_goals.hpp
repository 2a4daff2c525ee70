#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <rcl_cxx/goal_uuid.hpp>
#include <string>
#include <tl/expected.hpp>

#include "ur_ros_rtde/detail/goal_context.hpp"
#include "ur_ros_rtde/plugin_host.hpp"

namespace ur_ros_rtde {

/// The reason for stopping a goal whose client has disappeared.
StopReason client_lost();

/// The outcome of a goal without a result, or whose result cannot be sent. Always has an error code.
Outcome missing_result(rcl_cxx::GoalStatus status);

/// The goals of one action that have no result yet, independent of the action's type. Thread-safe.
class ActiveGoals {
 public:
  using Work = std::function<void(std::shared_ptr<GoalContext>)>;

  /// `action` is the resolved name.
  ActiveGoals(PluginHost & host, std::string action) : host_(host), action_(std::move(action)) {}
  ActiveGoals(const ActiveGoals &) = delete;
  ActiveGoals & operator=(const ActiveGoals &) = delete;

  const std::string & action() const { return action_; }

  /// Registers a goal if `check` succeeds. Otherwise the reason is published on goal_refusals and returned
  /// for the log. `check` may throw. The action server has made sure that no other goal has this id.
  tl::expected<void, std::string> accept(const rcl_cxx::GoalUUID & id,
                                         const std::function<Status(GoalContext &)> & check);
  /// Discards a goal that accept() has registered, publishes the reason on goal_refusals and returns it for
  /// the log.
  tl::unexpected<std::string> reject(const rcl_cxx::GoalUUID & id, const Error & reason);
  /// Runs `work`, which must not throw, in a thread of its own before the goal is accepted.
  Status start_check(const rcl_cxx::GoalUUID & id, Work work);
  /// Runs `work`, which must not throw, in a thread of its own for an accepted goal.
  Status start(const rcl_cxx::GoalUUID & id, Work work);
  /// Asks a goal to stop. Does nothing if the goal is not active.
  void stop(const rcl_cxx::GoalUUID & id, const StopReason & reason);
  /// Removes an accepted goal that will not be executed and releases its lease.
  void discard(const rcl_cxx::GoalUUID & id);
  /// Removes a goal before its result is sent, releases its lease and logs the outcome.
  void finish(const rcl_cxx::GoalUUID & id, const Outcome & outcome);
  void warn(const rcl_cxx::GoalUUID & id, const std::string & text) const;

 private:
  /// Publishes the reason and returns it for the log.
  tl::unexpected<std::string> publish_refusal(const rcl_cxx::GoalUUID & id, const Error & reason);
  Status start_thread(std::string name, const std::shared_ptr<GoalContext> & context, Work work);
  std::shared_ptr<GoalContext> find(const rcl_cxx::GoalUUID & id) const;
  std::shared_ptr<GoalContext> remove(const rcl_cxx::GoalUUID & id);

  PluginHost & host_;
  const std::string action_;
  mutable std::mutex mutex_;
  std::map<rcl_cxx::GoalUUID, std::shared_ptr<GoalContext>> contexts_;
};

}  // namespace ur_ros_rtde
