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
#include "rcl_cxx/qos.hpp"
#include "rcl_cxx/server_goal_handle.hpp"

namespace rcl_cxx {
struct ActionServerOptions {
  QoS goal_service_qos = QoS::services_default();
  QoS result_service_qos = QoS::services_default();
  QoS cancel_service_qos = QoS::services_default();
  QoS feedback_qos = QoS::reliable(10);
  QoS status_qos = QoS::transient_local(1);
  /// How long the result of an ended goal can be asked for; unset: rcl_action's default (10 s; Humble: 15
  /// min); negative: for ever.
  std::optional<std::chrono::nanoseconds> result_timeout{};
};

/// What a server does with its goals. All run in the executor's thread and must return soon: a goal is
/// carried out in a thread of the user's.
template <typename A>
struct ActionServerCallbacks {
  using Goal = typename A::Goal;

  /// Accepts or rejects a goal, or defers the response. Empty: accepts every goal. An exception rejects the
  /// goal with its text.
  std::function<GoalDecision(const GoalUUID &, const Goal &)> handle_goal{};
  /// Gets the goal, EXECUTING already. Whoever keeps the handle owes the goal a result. An exception aborts
  /// it.
  std::function<void(std::shared_ptr<ServerGoalHandle<A>>)> handle_accepted{};
  /// Grants (true) or refuses a request to cancel an active goal. Empty: refuses. An exception refuses.
  std::function<bool(ServerGoalHandle<A> &)> handle_cancel{};
  /// Runs when the goal has become CANCELING (is_canceling() is true): the place to wake its worker.
  /// Optional.
  std::function<void(ServerGoalHandle<A> &)> on_canceling{};
  /// Runs once when the client that sent an active goal has disappeared: its process has ended, or it has
  /// destroyed its action client. The goal goes on unless this ends it. Optional: without it clients are not
  /// watched. A process that was killed disappears when its participant's lease ends.
  std::function<void(ServerGoalHandle<A> &)> on_client_lost{};
  /// Runs when a goal that `handle_goal` accepted will not be accepted after all: its client could not be
  /// told. Optional.
  std::function<void(const GoalUUID &)> on_goal_discarded{};
  /// Fills in a result that the server gives by itself: for a goal that it does not know
  /// (GoalStatus::unknown) or that ended without a result that can be sent. Any thread; must not throw.
  /// Optional: it is empty then.
  std::function<void(GoalStatus, typename A::Result &)> fill_missing_result{};
};

namespace detail {
class ActionServerImpl;

/// What the server needs to know of an action's types; one constant table per action.
struct ActionServerOps {
  const rosidl_action_type_support_t * (*type_support)();
  std::shared_ptr<void> (*make_goal_request)();
  GoalUUID (*goal_id_of_goal_request)(const void *);
  std::shared_ptr<void> (*make_goal_response)(bool accepted, std::int32_t sec, std::uint32_t nanosec);
  std::shared_ptr<void> (*make_result_request)();
  GoalUUID (*goal_id_of_result_request)(const void *);
  std::shared_ptr<void> (*make_result_response)(GoalStatus);
  std::shared_ptr<ServerGoalHandleBase> (*make_handle)(std::shared_ptr<ServerGoalImpl>,
                                                       std::shared_ptr<void> goal_request);
};

struct ErasedActionServer {
  const ActionServerOps * ops;
  std::function<GoalDecision(const GoalUUID &, const void * goal_request)> goal{};
  std::function<void(std::shared_ptr<ServerGoalHandleBase>)> accepted{};
  std::function<bool(ServerGoalHandleBase &)> cancel{};
  std::function<void(ServerGoalHandleBase &)> canceling{};
  std::function<void(ServerGoalHandleBase &)> client_lost{};
  std::function<void(const GoalUUID &)> discarded{};
  std::function<void(GoalStatus, void * result_response)> missing_result{};
};

template <typename A>
struct ActionServerOpsOf {
  using GoalRequest = typename A::Impl::SendGoalService::Request;
  using GoalResponse = typename A::Impl::SendGoalService::Response;
  using ResultRequest = typename A::Impl::GetResultService::Request;
  using ResultResponse = typename A::Impl::GetResultService::Response;

  static std::shared_ptr<void> goal_response(bool accepted, std::int32_t sec, std::uint32_t nanosec)
  {
    auto response = std::make_shared<GoalResponse>();
    response->accepted = accepted;
    response->stamp.sec = sec;
    response->stamp.nanosec = nanosec;
    return response;
  }

  static std::shared_ptr<void> result_response(GoalStatus status)
  {
    auto response = std::make_shared<ResultResponse>();
    response->status = static_cast<std::int8_t>(status);
    return response;
  }

  static constexpr ActionServerOps ops{
      &rosidl_typesupport_cpp::get_action_type_support_handle<A>,
      []() -> std::shared_ptr<void> { return std::make_shared<GoalRequest>(); },
      [](const void * request) { return GoalUUID{static_cast<const GoalRequest *>(request)->goal_id.uuid}; },
      &goal_response,
      []() -> std::shared_ptr<void> { return std::make_shared<ResultRequest>(); },
      [](const void * request) {
        return GoalUUID{static_cast<const ResultRequest *>(request)->goal_id.uuid};
      },
      &result_response,
      [](std::shared_ptr<ServerGoalImpl> impl,
         std::shared_ptr<void> request) -> std::shared_ptr<ServerGoalHandleBase> {
        return std::make_shared<ServerGoalHandle<A>>(std::move(impl),
                                                     std::static_pointer_cast<const GoalRequest>(request));
      }};
};
}  // namespace detail

class ActionServerBase {
 public:
  /// Aborts, with empty results, the goals that have none; after that no handler runs any more. Handles that
  /// are still held stay valid and inactive.
  virtual ~ActionServerBase();
  ActionServerBase(const ActionServerBase &) = delete;
  ActionServerBase & operator=(const ActionServerBase &) = delete;

  /// The resolved name, "/robot/move_l".
  const std::string & get_action_name() const noexcept;
  /// Goals without a result.
  std::size_t active_goal_count() const;

 protected:
  explicit ActionServerBase(std::shared_ptr<detail::ActionServerImpl> impl);

 private:
  std::shared_ptr<detail::ActionServerImpl> impl_;
};

/// From Node::create_action_server. Results are cached for ActionServerOptions::result_timeout after a goal's
/// end. When the context shuts down, what is active after its add_pre_shutdown_callback callbacks is aborted.
template <typename A>
class ActionServer : public ActionServerBase {
 public:
  using SharedPtr = std::shared_ptr<ActionServer<A>>;

  explicit ActionServer(std::shared_ptr<detail::ActionServerImpl> impl) : ActionServerBase(std::move(impl)) {}

  static detail::ErasedActionServer erase(ActionServerCallbacks<A> handlers)
  {
    using GoalRequest = typename A::Impl::SendGoalService::Request;
    using Handle = ServerGoalHandle<A>;
    detail::ErasedActionServer erased{.ops = &detail::ActionServerOpsOf<A>::ops};
    if (handlers.handle_goal) {
      erased.goal = [f = std::move(handlers.handle_goal)](const GoalUUID & id, const void * request) {
        return f(id, static_cast<const GoalRequest *>(request)->goal);
      };
    }
    if (handlers.handle_accepted) {
      erased.accepted =
          [f = std::move(handlers.handle_accepted)](std::shared_ptr<ServerGoalHandleBase> handle) {
            f(std::static_pointer_cast<Handle>(std::move(handle)));
          };
    }
    if (handlers.handle_cancel) {
      erased.cancel = [f = std::move(handlers.handle_cancel)](ServerGoalHandleBase & handle) {
        return f(static_cast<Handle &>(handle));
      };
    }
    erased.canceling = erase_handle(std::move(handlers.on_canceling));
    erased.client_lost = erase_handle(std::move(handlers.on_client_lost));
    erased.discarded = std::move(handlers.on_goal_discarded);
    if (handlers.fill_missing_result) {
      using ResultResponse = typename A::Impl::GetResultService::Response;
      erased.missing_result = [f = std::move(handlers.fill_missing_result)](GoalStatus status,
                                                                            void * response) {
        f(status, static_cast<ResultResponse *>(response)->result);
      };
    }
    return erased;
  }

 private:
  static std::function<void(ServerGoalHandleBase &)> erase_handle(
      std::function<void(ServerGoalHandle<A> &)> handler)
  {
    if (!handler) {
      return {};
    }
    return [f = std::move(handler)](ServerGoalHandleBase & handle) {
      f(static_cast<ServerGoalHandle<A> &>(handle));
    };
  }
};

}  // namespace rcl_cxx
