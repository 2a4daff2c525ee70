#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "rcl_cxx/node.hpp"

namespace rcl_cxx {

/// ServerGoalHandle with the types of an action.
template <typename A>
class TypedGoalHandle {
 public:
  using Result = typename A::Result;

  explicit TypedGoalHandle(ServerGoalHandle::SharedPtr handle) : handle_(std::move(handle)) {}
  /// Does not own the handle.
  explicit TypedGoalHandle(ServerGoalHandle & handle) : handle_(std::shared_ptr<void>(), &handle) {}

  const typename A::Goal & get_goal() const
  {
    return *static_cast<const typename A::Goal *>(handle_->get_goal());
  }
  const GoalUUID & get_goal_id() const { return handle_->get_goal_id(); }
  GoalStatus get_status() const { return handle_->get_status(); }
  bool is_active() const { return handle_->is_active(); }
  bool is_canceling() const { return handle_->is_canceling(); }
  std::int64_t get_goal_stamp() const { return handle_->get_goal_stamp(); }
  void keep_watching_client() { handle_->keep_watching_client(); }

  bool publish_feedback(const typename A::Feedback & feedback)
  {
    return handle_->publish_feedback(&feedback);
  }
  bool succeed(const Result & result = Result()) { return handle_->succeed(&result); }
  bool abort(const Result & result = Result()) { return handle_->abort(&result); }
  bool canceled(const Result & result = Result()) { return handle_->canceled(&result); }

 private:
  ServerGoalHandle::SharedPtr handle_;
};

/// ActionServerCallbacks with the types of an action.
template <typename A>
struct TypedCallbacks {
  using Handle = TypedGoalHandle<A>;
  std::function<GoalDecision(const GoalUUID &, const typename A::Goal &)> handle_goal{};
  std::function<void(std::shared_ptr<Handle>)> handle_accepted{};
  std::function<bool(Handle &)> handle_cancel{};
  std::function<void(Handle &)> on_canceling{};
  std::function<void(Handle &)> on_client_lost{};
  std::function<void(const GoalUUID &)> on_goal_discarded{};
  std::function<void(GoalStatus, typename A::Result &)> fill_missing_result{};
};

/// Callbacks that are not set remain unset.
template <typename A>
ActionServerCallbacks erase_types(TypedCallbacks<A> typed)
{
  const auto erase_handle = [](auto callback) -> std::function<void(ServerGoalHandle &)> {
    if (!callback) {
      return {};
    }
    return [callback](ServerGoalHandle & handle) {
      TypedGoalHandle<A> goal(handle);
      callback(goal);
    };
  };
  ActionServerCallbacks callbacks;
  if (typed.handle_goal) {
    callbacks.handle_goal = [f = typed.handle_goal](const GoalUUID & id, const void * goal) {
      return f(id, *static_cast<const typename A::Goal *>(goal));
    };
  }
  if (typed.handle_accepted) {
    callbacks.handle_accepted = [f = typed.handle_accepted](ServerGoalHandle::SharedPtr handle) {
      f(std::make_shared<TypedGoalHandle<A>>(std::move(handle)));
    };
  }
  if (typed.handle_cancel) {
    callbacks.handle_cancel = [f = typed.handle_cancel](ServerGoalHandle & handle) {
      TypedGoalHandle<A> goal(handle);
      return f(goal);
    };
  }
  callbacks.on_canceling = erase_handle(typed.on_canceling);
  callbacks.on_client_lost = erase_handle(typed.on_client_lost);
  callbacks.on_goal_discarded = typed.on_goal_discarded;
  if (typed.fill_missing_result) {
    callbacks.fill_missing_result = [f = typed.fill_missing_result](GoalStatus status, void * result) {
      f(status, *static_cast<typename A::Result *>(result));
    };
  }
  return callbacks;
}

template <typename A>
ActionServer::SharedPtr create_action_server(Node & node, const std::string & action,
                                             TypedCallbacks<A> callbacks,
                                             const ActionServerOptions & options = {})
{
  return node.create_action_server<A>(action, erase_types<A>(std::move(callbacks)), options);
}

}  // namespace rcl_cxx
