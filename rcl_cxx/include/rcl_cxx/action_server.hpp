#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <rosidl_typesupport_cpp/action_type_support.hpp>
#include <string>
#include <tl/expected.hpp>

#include "rcl_cxx/goal_response.hpp"
#include "rcl_cxx/server_goal_handle.hpp"

namespace rcl_cxx {
struct ActionServerOptions {
  /// How long the result of a finished goal is kept. Unset: rcl_action's default (10 s; Humble: 15 min).
  /// Negative: for ever.
  std::optional<std::chrono::nanoseconds> result_timeout{};
};

/// The callbacks of an action server. They run in the executor's thread and must return soon: a goal is
/// executed in a thread of the user. Only handle_accepted is mandatory.
template <typename A>
struct ActionServerCallbacks {
  /// Accepts a goal, rejects it with a reason, which is logged as a warning, or defers the response. An
  /// exception rejects the goal. Default: accepts every goal.
  std::function<GoalDecision(const GoalUUID &, const typename A::Goal &)> handle_goal{};
  /// Receives an accepted goal; its status is EXECUTING. The holder of the handle has to finish the goal. An
  /// exception aborts it.
  std::function<void(std::shared_ptr<ServerGoalHandle<A>>)> handle_accepted{};
  /// Returns whether to accept a request to cancel an active goal. An exception rejects the request. Default:
  /// rejects every request.
  std::function<bool(ServerGoalHandle<A> &)> handle_cancel{};
  /// Called when the goal has become CANCELING, for instance to wake the thread that executes it.
  std::function<void(ServerGoalHandle<A> &)> on_canceling{};
  /// Called once when the client of an active goal has disappeared: its process has ended, or it has
  /// destroyed its action client. A process that was killed disappears when the lease of its participant
  /// expires. The goal remains active. Clients are watched only if this is set.
  std::function<void(ServerGoalHandle<A> &)> on_client_lost{};
  /// Called when a goal that handle_goal accepted is not executed: the acceptance could not be delivered to
  /// the client.
  std::function<void(const GoalUUID &)> on_goal_discarded{};
  /// Fills in a result of the server itself: for an unknown goal (GoalStatus::unknown), and for a goal
  /// without a result that can be sent. Runs in any thread. Default: an empty result.
  std::function<void(GoalStatus, typename A::Result &)> fill_missing_result{};
};

namespace detail {
class ActionServerImpl;
class NodeImpl;

/// ActionServerCallbacks, and what the server has to know about the types of an action.
struct ErasedActionServer {
  const rosidl_action_type_support_t * type_support;
  std::shared_ptr<void> (*make_goal_request)();
  GoalUUID (*goal_id_of_goal_request)(const void *);
  std::shared_ptr<void> (*make_goal_response)(bool accepted, std::int32_t sec, std::uint32_t nanosec);
  std::shared_ptr<void> (*make_result_request)();
  GoalUUID (*goal_id_of_result_request)(const void *);
  std::shared_ptr<void> (*make_result_response)(GoalStatus);
  std::shared_ptr<ServerGoalHandleBase> (*make_handle)(std::shared_ptr<ServerGoalImpl>,
                                                       std::shared_ptr<void> goal_request);

  std::function<GoalDecision(const GoalUUID &, const void * goal_request)> handle_goal{};
  std::function<void(std::shared_ptr<ServerGoalHandleBase>)> handle_accepted{};
  std::function<bool(ServerGoalHandleBase &)> handle_cancel{};
  std::function<void(ServerGoalHandleBase &)> on_canceling{};
  std::function<void(ServerGoalHandleBase &)> on_client_lost{};
  std::function<void(const GoalUUID &)> on_goal_discarded{};
  std::function<void(GoalStatus, void * result_response)> fill_missing_result{};
};

/// The functions of ErasedActionServer that depend on the types of `A`, without callbacks.
template <typename A>
ErasedActionServer erase_action_types()
{
  using GoalRequest = typename A::Impl::SendGoalService::Request;
  using GoalResponse = typename A::Impl::SendGoalService::Response;
  using ResultRequest = typename A::Impl::GetResultService::Request;
  using ResultResponse = typename A::Impl::GetResultService::Response;

  return {
      rosidl_typesupport_cpp::get_action_type_support_handle<A>(),
      []() -> std::shared_ptr<void> { return std::make_shared<GoalRequest>(); },
      [](const void * request) { return GoalUUID{static_cast<const GoalRequest *>(request)->goal_id.uuid}; },
      [](bool accepted, std::int32_t sec, std::uint32_t nanosec) -> std::shared_ptr<void> {
        auto response = std::make_shared<GoalResponse>();
        response->accepted = accepted;
        response->stamp.sec = sec;
        response->stamp.nanosec = nanosec;
        return response;
      },
      []() -> std::shared_ptr<void> { return std::make_shared<ResultRequest>(); },
      [](const void * request) {
        return GoalUUID{static_cast<const ResultRequest *>(request)->goal_id.uuid};
      },
      [](GoalStatus status) -> std::shared_ptr<void> {
        auto response = std::make_shared<ResultResponse>();
        response->status = static_cast<std::int8_t>(status);
        return response;
      },
      [](std::shared_ptr<ServerGoalImpl> impl,
         std::shared_ptr<void> request) -> std::shared_ptr<ServerGoalHandleBase> {
        return std::make_shared<ServerGoalHandle<A>>(std::move(impl),
                                                     std::static_pointer_cast<const GoalRequest>(request));
      }};
}

template <typename A>
ErasedActionServer erase_action_server(ActionServerCallbacks<A> callbacks)
{
  using GoalRequest = typename A::Impl::SendGoalService::Request;
  using ResultResponse = typename A::Impl::GetResultService::Response;
  using Handle = ServerGoalHandle<A>;

  ErasedActionServer erased = erase_action_types<A>();
  const auto erase_handle = [](auto callback) -> std::function<void(ServerGoalHandleBase &)> {
    if (!callback) {
      return {};
    }
    return [f = std::move(callback)](ServerGoalHandleBase & handle) { f(static_cast<Handle &>(handle)); };
  };
  if (callbacks.handle_goal) {
    erased.handle_goal = [f = std::move(callbacks.handle_goal)](const GoalUUID & id, const void * request) {
      return f(id, static_cast<const GoalRequest *>(request)->goal);
    };
  }
  if (callbacks.handle_accepted) {
    erased.handle_accepted =
        [f = std::move(callbacks.handle_accepted)](std::shared_ptr<ServerGoalHandleBase> handle) {
          f(std::static_pointer_cast<Handle>(std::move(handle)));
        };
  }
  if (callbacks.handle_cancel) {
    erased.handle_cancel = [f = std::move(callbacks.handle_cancel)](ServerGoalHandleBase & handle) {
      return f(static_cast<Handle &>(handle));
    };
  }
  erased.on_canceling = erase_handle(std::move(callbacks.on_canceling));
  erased.on_client_lost = erase_handle(std::move(callbacks.on_client_lost));
  erased.on_goal_discarded = std::move(callbacks.on_goal_discarded);
  if (callbacks.fill_missing_result) {
    erased.fill_missing_result = [f = std::move(callbacks.fill_missing_result)](GoalStatus status,
                                                                                void * response) {
      f(status, static_cast<ResultResponse *>(response)->result);
    };
  }
  return erased;
}
}  // namespace detail

class ActionServerBase {
 public:
  ActionServerBase(std::shared_ptr<detail::NodeImpl> node, const std::string & action,
                   detail::ErasedActionServer erased, const ActionServerOptions & options);
  /// Aborts the active goals. No callback runs afterwards. Handles that are still held remain valid and
  /// inactive.
  virtual ~ActionServerBase();
  ActionServerBase(const ActionServerBase &) = delete;
  ActionServerBase & operator=(const ActionServerBase &) = delete;

 private:
  std::shared_ptr<detail::ActionServerImpl> impl_;
};

/// Created by Node::create_action_server. Every accepted goal gets exactly one result, which is kept for
/// ActionServerOptions::result_timeout. At the shutdown of the context, the goals that are active after the
/// pre-shutdown callbacks are aborted.
template <typename A>
class ActionServer : public ActionServerBase {
 public:
  using SharedPtr = std::shared_ptr<ActionServer<A>>;

  ActionServer(std::shared_ptr<detail::NodeImpl> node, const std::string & action,
               ActionServerCallbacks<A> callbacks, const ActionServerOptions & options)
      : ActionServerBase(std::move(node), action, detail::erase_action_server<A>(std::move(callbacks)),
                         options)
  {
  }
};

}  // namespace rcl_cxx
