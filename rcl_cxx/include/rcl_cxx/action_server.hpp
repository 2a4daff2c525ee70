#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "rcl_cxx/action_type.hpp"
#include "rcl_cxx/callback_group.hpp"
#include "rcl_cxx/goal_response.hpp"
#include "rcl_cxx/server_goal_handle.hpp"

namespace rcl_cxx {
namespace detail {
class ActionAnnouncement;
class ActionServerImpl;
class NodeImpl;
}  // namespace detail

struct ActionServerOptions {
  /// How long the result of a finished goal is kept. Unset: rcl_action's default (10 s; Humble: 15 min).
  /// Negative: for ever.
  std::optional<std::chrono::nanoseconds> result_timeout{};
  /// For goal requests: handle_goal, handle_accepted. Empty: the default group of the node.
  CallbackGroup::SharedPtr goal_callback_group{};
  /// For requests to cancel a goal, requests for results, and lost clients. Empty: the default group of the
  /// node. Their callbacks may run at the same time as those of goal requests.
  CallbackGroup::SharedPtr cancel_callback_group{};
  /// If set, the server is created on demand, in the executor of this group: until the first action client
  /// appears, only the publisher of feedback exists, by which ROS lists actions. Clients wait for the server
  /// as for any other; a program that uses the services of the action without an action client finds none.
  /// Empty, and on Humble, which reports no new subscriptions: the server is created at once.
  CallbackGroup::SharedPtr creation_callback_group{};
};

/// The callbacks of an action server. They run in the thread of the executor of their group and must return
/// soon: a goal is executed in a thread of the user. Only handle_accepted is mandatory. `goal` is an A::Goal,
/// `result` an A::Result, for the `A` of Node::create_action_server<A>.
struct ActionServerCallbacks {
  /// Accepts a goal, rejects it with a reason, which is logged as a warning, or defers the response. An
  /// exception rejects the goal. Default: accepts every goal.
  std::function<GoalDecision(const GoalUUID &, const void * goal)> handle_goal{};
  /// Receives an accepted goal; its status is EXECUTING. The holder of the handle has to finish the goal. An
  /// exception aborts it.
  std::function<void(std::shared_ptr<ServerGoalHandle>)> handle_accepted{};
  /// Returns whether to accept a request to cancel an active goal. An exception rejects the request. Default:
  /// rejects every request.
  std::function<bool(ServerGoalHandle &)> handle_cancel{};
  /// Called when the goal has become CANCELING, for instance to wake the thread that executes it.
  std::function<void(ServerGoalHandle &)> on_canceling{};
  /// Called once when the client of an active goal has disappeared: its process has ended, or it has
  /// destroyed its action client. A process that was killed disappears when the lease of its participant
  /// expires. The goal remains active. Clients are watched only if this is set; see also
  /// ServerGoalHandle::keep_watching_client().
  std::function<void(ServerGoalHandle &)> on_client_lost{};
  /// Called when a goal that handle_goal accepted is not executed: the acceptance could not be delivered to
  /// the client.
  std::function<void(const GoalUUID &)> on_goal_discarded{};
  /// Fills in a result of the server itself: for an unknown goal (GoalStatus::unknown), and for a goal
  /// without a result that can be sent. Runs in any thread. Default: an empty result.
  std::function<void(GoalStatus, void * result)> fill_missing_result{};
};

/// Created by Node::create_action_server. Every accepted goal gets exactly one result, which is kept for
/// ActionServerOptions::result_timeout. At the shutdown of the context, the goals that are active after the
/// pre-shutdown callbacks are aborted.
class ActionServer {
 public:
  using SharedPtr = std::shared_ptr<ActionServer>;

  ActionServer(std::shared_ptr<detail::NodeImpl> node, const ActionType & type, const std::string & action,
               ActionServerCallbacks callbacks, const ActionServerOptions & options);
  /// Aborts the active goals. No callback runs afterwards. Handles that are still held remain valid and
  /// inactive.
  ~ActionServer();
  ActionServer(const ActionServer &) = delete;
  ActionServer & operator=(const ActionServer &) = delete;

 private:
  std::shared_ptr<detail::ActionServerImpl> impl_;
  std::shared_ptr<detail::ActionAnnouncement> announcement_;  ///< creates it on demand, instead of impl_
};

}  // namespace rcl_cxx
