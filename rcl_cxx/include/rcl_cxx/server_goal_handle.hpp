#pragma once

#include <cstdint>
#include <memory>
#include <mutex>

#include "rcl_cxx/action_type.hpp"
#include "rcl_cxx/goal_uuid.hpp"

namespace rcl_cxx {
namespace detail {
class ServerGoalImpl;
}

/// A goal that an action server has accepted. All members are thread-safe, do not throw, and may be called
/// when the server has been destroyed. Goal, result and feedback are those of the server's action type.
class ServerGoalHandle {
 public:
  using SharedPtr = std::shared_ptr<ServerGoalHandle>;

  ServerGoalHandle(std::shared_ptr<detail::ServerGoalImpl> impl, const ActionType & type,
                   std::shared_ptr<const void> goal_request);
  /// Aborts a goal that has no result yet, with an empty result, and logs that.
  ~ServerGoalHandle();
  ServerGoalHandle(const ServerGoalHandle &) = delete;
  ServerGoalHandle & operator=(const ServerGoalHandle &) = delete;

  const void * get_goal() const noexcept;
  const GoalUUID & get_goal_id() const noexcept;
  GoalStatus get_status() const noexcept;
  /// True until the goal has a result, or the server or the context ends.
  bool is_active() const noexcept;
  /// True if a cancel request has been accepted and the goal has no result yet.
  bool is_canceling() const noexcept;
  /// The time of the acceptance in nanoseconds since the epoch, ROS time. Cancel requests compare with it.
  std::int64_t get_goal_stamp() const noexcept;

  /// For what outlasts the goal: on_client_lost is called for its client also after the goal has its result,
  /// as long as this handle exists. Call it while the goal is active.
  void keep_watching_client() noexcept;

  /// Returns false and publishes nothing when the goal has a result. A failure is logged.
  bool publish_feedback(const void * feedback) noexcept;
  /// The first call of succeed, abort or canceled takes effect and returns true. Further calls return false
  /// and are logged.
  bool succeed(const void * result) noexcept { return finish(GoalStatus::succeeded, result); }
  bool abort(const void * result) noexcept { return finish(GoalStatus::aborted, result); }
  /// Only for a goal that is_canceling() or whose handle_cancel is running. Abort other goals.
  bool canceled(const void * result) noexcept { return finish(GoalStatus::canceled, result); }

 private:
  bool finish(GoalStatus status, const void * result) noexcept;
  void log_exception(const char * what) const noexcept;

  const std::shared_ptr<detail::ServerGoalImpl> impl_;
  const ActionType & type_;
  const std::shared_ptr<const void> goal_request_;
  std::mutex feedback_mutex_;
  const std::shared_ptr<void> feedback_message_;  // reused: its vectors keep their capacity
};

}  // namespace rcl_cxx
