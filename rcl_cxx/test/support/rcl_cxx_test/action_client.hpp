#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "rcl_cxx/action_type.hpp"
#include "rcl_cxx/goal_uuid.hpp"
#include "rcl_cxx/node.hpp"

namespace rcl_cxx {
/// Values match action_msgs/srv/CancelGoal.
enum class CancelCode : std::int8_t { none = 0, rejected = 1, unknown_goal = 2, goal_terminated = 3 };

struct CancelResponse {
  CancelCode code = CancelCode::none;
  /// The goals that are being canceled.
  std::vector<GoalUUID> goals;
};

template <typename A>
struct WrappedResult {
  GoalUUID goal_id;
  /// succeeded, canceled or aborted; unknown if the server does not know the goal (anymore).
  GoalStatus status = GoalStatus::unknown;
  typename A::Result result;
};

namespace detail {
class ActionClientImpl;
class ClientGoalImpl;

/// What the client has to know about the types of an action.
struct ActionClientOps {
  const ActionType & type;
  std::shared_ptr<void> (*make_goal_request)(const GoalUUID &, const void * goal);
  bool (*accepted)(const void * goal_response);
  std::shared_ptr<void> (*make_result_request)(const GoalUUID &);
  std::int8_t (*status)(const void * result_response);
  GoalUUID (*goal_id_of_feedback)(const void * feedback_message);
};

/// Run in the executor's thread.
struct ErasedGoalCallbacks {
  std::function<void(const std::shared_ptr<ClientGoalImpl> & or_null_if_rejected)> response;
  std::function<void(const void * feedback_message)> feedback;
  std::function<void(const GoalUUID &, const void * result_response)> result;
};

template <typename A>
struct ActionClientOpsOf {
  using GoalRequest = typename A::Impl::SendGoalService::Request;
  using GoalResponse = typename A::Impl::SendGoalService::Response;
  using ResultRequest = typename A::Impl::GetResultService::Request;
  using ResultResponse = typename A::Impl::GetResultService::Response;
  using FeedbackMessage = typename A::Impl::FeedbackMessage;

  static std::shared_ptr<void> goal_request(const GoalUUID & id, const void * goal)
  {
    auto request = std::make_shared<GoalRequest>();
    request->goal_id.uuid = id.bytes;
    request->goal = *static_cast<const typename A::Goal *>(goal);
    return request;
  }

  static std::shared_ptr<void> result_request(const GoalUUID & id)
  {
    auto request = std::make_shared<ResultRequest>();
    request->goal_id.uuid = id.bytes;
    return request;
  }

  static const ActionClientOps & ops()
  {
    static const ActionClientOps functions{
        action_type<A>(),
        &goal_request,
        [](const void * response) { return bool{static_cast<const GoalResponse *>(response)->accepted}; },
        &result_request,
        [](const void * response) {
          return std::int8_t{static_cast<const ResultResponse *>(response)->status};
        },
        [](const void * feedback) {
          return GoalUUID{static_cast<const FeedbackMessage *>(feedback)->goal_id.uuid};
        }};
    return functions;
  }
};
}  // namespace detail

/// An accepted goal of a client.
class ClientGoalHandleBase {
 public:
  explicit ClientGoalHandleBase(std::shared_ptr<detail::ClientGoalImpl> impl);
  virtual ~ClientGoalHandleBase();
  ClientGoalHandleBase(const ClientGoalHandleBase &) = delete;
  ClientGoalHandleBase & operator=(const ClientGoalHandleBase &) = delete;

  const GoalUUID & get_goal_id() const noexcept;
  /// The last known status.
  GoalStatus get_status() const noexcept;

  /// Requests to cancel the goal. @throws Error if the request cannot be sent.
  std::future<CancelResponse> async_cancel();

 private:
  std::shared_ptr<detail::ClientGoalImpl> impl_;
};

template <typename A>
class ClientGoalHandle : public ClientGoalHandleBase {
 public:
  using SharedPtr = std::shared_ptr<ClientGoalHandle<A>>;

  ClientGoalHandle(std::shared_ptr<detail::ClientGoalImpl> impl, std::shared_future<WrappedResult<A>> result)
      : ClientGoalHandleBase(std::move(impl)), result_(std::move(result))
  {
  }

  /// Ready when the goal has a result. Broken (std::future_error) if the action client is destroyed first.
  const std::shared_future<WrappedResult<A>> & async_get_result() const noexcept { return result_; }

 private:
  std::shared_future<WrappedResult<A>> result_;
};

/// Optional callbacks, which run in the executor's thread.
template <typename A>
struct SendGoalOptions {
  /// Receives a null pointer if the goal was rejected.
  std::function<void(const std::shared_ptr<ClientGoalHandle<A>> &)> goal_response_callback{};
  std::function<void(const typename A::Feedback &)> feedback_callback{};
  std::function<void(const WrappedResult<A> &)> result_callback{};
};

class ActionClientBase {
 public:
  virtual ~ActionClientBase();
  ActionClientBase(const ActionClientBase &) = delete;
  ActionClientBase & operator=(const ActionClientBase &) = delete;

  const std::string & get_action_name() const noexcept;
  bool action_server_is_ready() const;
  /// Returns false on timeout and shutdown.
  bool wait_for_action_server(std::chrono::nanoseconds timeout) const;

  /// Requests to cancel the goal of any client. @throws Error if the request cannot be sent; the same below.
  std::future<CancelResponse> async_cancel_goal(const GoalUUID & id);
  std::future<CancelResponse> async_cancel_all_goals();
  /// All goals accepted at or before `stamp_ns` (nanoseconds since the epoch, ROS time).
  std::future<CancelResponse> async_cancel_goals_before(std::int64_t stamp_ns);

 protected:
  ActionClientBase(std::shared_ptr<detail::NodeImpl> node, const detail::ActionClientOps & ops,
                   const std::string & action);
  GoalUUID send(const void * goal, detail::ErasedGoalCallbacks callbacks);
  /// Cancels a goal that is no longer waited for, now or when it is accepted.
  void abandon(const GoalUUID & id) noexcept;
  /// Returns false at `deadline` and on shutdown.
  template <typename Future>
  bool wait(const Future & future, std::chrono::steady_clock::time_point deadline) const
  {
    return wait_until_ready(
        [&future](std::chrono::nanoseconds slice) {
          return future.wait_for(slice) == std::future_status::ready;
        },
        deadline);
  }
  /// The error is the reason why a blocking call is impossible.
  tl::expected<void, std::string> check_blocking_call(std::chrono::nanoseconds timeout) const;

 private:
  bool wait_until_ready(const std::function<bool(std::chrono::nanoseconds)> & ready_within,
                        std::chrono::steady_clock::time_point deadline) const;

  std::shared_ptr<detail::ActionClientImpl> impl_;
};

/// An action client for tests, created by create_action_client. Thread-safe. Responses arrive in the
/// executor's thread. The result is requested as soon as a goal is accepted.
template <typename A>
class ActionClient : public ActionClientBase {
 public:
  using SharedPtr = std::shared_ptr<ActionClient<A>>;
  using Goal = typename A::Goal;
  using Feedback = typename A::Feedback;
  using Handle = ClientGoalHandle<A>;

  ActionClient(std::shared_ptr<detail::NodeImpl> node, const std::string & action)
      : ActionClientBase(std::move(node), detail::ActionClientOpsOf<A>::ops(), action)
  {
  }

  /// The future holds the goal's handle, or a null pointer if the goal was rejected.
  /// @throws Error if the request cannot be sent.
  std::future<std::shared_ptr<Handle>> async_send_goal(const Goal & goal, SendGoalOptions<A> options = {})
  {
    return start(goal, std::move(options)).response;
  }

  /// Sends a goal and waits for its result, at most `timeout`. The executor has to spin in another thread. A
  /// goal that is active at the timeout is canceled. The error is the reason: no server, rejected, no
  /// response, no result, shutdown, or called from a callback of the executor.
  tl::expected<WrappedResult<A>, std::string> send_goal(
      const Goal & goal, std::chrono::nanoseconds timeout,
      std::function<void(const Feedback &)> on_feedback = {});

 private:
  using ResultResponse = typename A::Impl::GetResultService::Response;
  using FeedbackMessage = typename A::Impl::FeedbackMessage;

  struct Started {
    GoalUUID id;
    std::future<std::shared_ptr<Handle>> response;
  };

  Started start(const Goal & goal, SendGoalOptions<A> options);
  tl::expected<WrappedResult<A>, std::string> send_goal_until(
      const Goal & goal, std::chrono::steady_clock::time_point deadline,
      std::function<void(const Feedback &)> on_feedback);
};

template <typename A>
typename ActionClient<A>::Started ActionClient<A>::start(const Goal & goal, SendGoalOptions<A> options)
{
  auto response_promise = std::make_shared<std::promise<std::shared_ptr<Handle>>>();
  auto result_promise = std::make_shared<std::promise<WrappedResult<A>>>();
  Started started{{}, response_promise->get_future()};

  detail::ErasedGoalCallbacks callbacks;
  callbacks.response =
      [response_promise, result = result_promise->get_future().share(),
       f = std::move(options.goal_response_callback)](const std::shared_ptr<detail::ClientGoalImpl> & impl) {
        auto handle = impl ? std::make_shared<Handle>(impl, result) : nullptr;
        response_promise->set_value(handle);
        if (f) {
          f(handle);
        }
      };
  if (options.feedback_callback) {
    callbacks.feedback = [f = std::move(options.feedback_callback)](const void * message) {
      f(static_cast<const FeedbackMessage *>(message)->feedback);
    };
  }
  callbacks.result = [result_promise, f = std::move(options.result_callback)](const GoalUUID & goal_id,
                                                                              const void * message) {
    const auto & response = *static_cast<const ResultResponse *>(message);
    WrappedResult<A> result{goal_id, static_cast<GoalStatus>(response.status), response.result};
    result_promise->set_value(result);
    if (f) {
      f(result);
    }
  };
  started.id = send(&goal, std::move(callbacks));
  return started;
}

template <typename A>
tl::expected<WrappedResult<A>, std::string> ActionClient<A>::send_goal(
    const Goal & goal, std::chrono::nanoseconds timeout, std::function<void(const Feedback &)> on_feedback)
{
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  if (auto ready = check_blocking_call(timeout); !ready) {
    return tl::make_unexpected(ready.error());
  }
  try {
    return send_goal_until(goal, deadline, std::move(on_feedback));
  } catch (const std::exception & error) {  // not sent, or the client was destroyed
    return tl::make_unexpected(get_action_name() + ": " + error.what());
  }
}

template <typename A>
tl::expected<WrappedResult<A>, std::string> ActionClient<A>::send_goal_until(
    const Goal & goal, std::chrono::steady_clock::time_point deadline,
    std::function<void(const Feedback &)> on_feedback)
{
  SendGoalOptions<A> options;
  options.feedback_callback = std::move(on_feedback);
  Started started = start(goal, std::move(options));
  if (!wait(started.response, deadline)) {
    abandon(started.id);
    return tl::make_unexpected(get_action_name() + ": no response to the goal within the timeout");
  }
  const std::shared_ptr<Handle> handle = started.response.get();
  if (!handle) {
    return tl::make_unexpected(get_action_name() + ": goal rejected, see the server's log");
  }
  if (!wait(handle->async_get_result(), deadline)) {
    abandon(started.id);
    return tl::make_unexpected(get_action_name() + ": no result within the timeout, cancel requested");
  }
  return handle->async_get_result().get();
}

template <typename A>
std::shared_ptr<ActionClient<A>> create_action_client(const Node & node, const std::string & action)
{
  return std::make_shared<ActionClient<A>>(node.impl(), action);
}

}  // namespace rcl_cxx
