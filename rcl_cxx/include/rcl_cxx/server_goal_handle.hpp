#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "rcl_cxx/goal_uuid.hpp"

namespace rcl_cxx {
namespace detail {
class ServerGoalImpl;
}

/// A goal that an action server has accepted. All members are thread-safe, do not throw, and may be called
/// when the server has been destroyed.
class ServerGoalHandleBase {
 public:
  /// Aborts a goal that has no result yet, with an empty result, and logs that.
  virtual ~ServerGoalHandleBase();
  ServerGoalHandleBase(const ServerGoalHandleBase &) = delete;
  ServerGoalHandleBase & operator=(const ServerGoalHandleBase &) = delete;

  const GoalUUID & get_goal_id() const noexcept;
  GoalStatus get_status() const noexcept;
  /// True until the goal has a result, or the server or the context ends.
  bool is_active() const noexcept;
  /// True if a cancel request has been accepted and the goal has no result yet.
  bool is_canceling() const noexcept;
  /// The time of the acceptance in nanoseconds since the epoch, ROS time. Cancel requests compare with it.
  std::int64_t get_goal_stamp() const noexcept;

 protected:
  explicit ServerGoalHandleBase(std::shared_ptr<detail::ServerGoalImpl> impl);
  bool finish(GoalStatus status, std::shared_ptr<void> result_response) noexcept;
  bool send_feedback(void * feedback_message) noexcept;
  void log_exception(const char * what) const noexcept;

 private:
  std::shared_ptr<detail::ServerGoalImpl> impl_;
};

/// See ServerGoalHandleBase. The first call of succeed, abort or canceled takes effect and returns true.
/// Further calls return false and are logged.
template <typename A>
class ServerGoalHandle : public ServerGoalHandleBase {
 public:
  using SharedPtr = std::shared_ptr<ServerGoalHandle<A>>;
  using Goal = typename A::Goal;
  using Result = typename A::Result;
  using Feedback = typename A::Feedback;
  using GoalRequest = typename A::Impl::SendGoalService::Request;

  ServerGoalHandle(std::shared_ptr<detail::ServerGoalImpl> impl, std::shared_ptr<const GoalRequest> request)
      : ServerGoalHandleBase(std::move(impl)), request_(std::move(request))
  {
    feedback_.goal_id.uuid = get_goal_id().bytes;
  }

  const Goal & get_goal() const noexcept { return request_->goal; }

  /// Returns false and publishes nothing when the goal has a result. A failure is logged.
  bool publish_feedback(const Feedback & feedback) noexcept
  {
    try {
      const std::lock_guard lock(feedback_mutex_);
      feedback_.feedback = feedback;  // the message is reused: its vectors keep their capacity
      return send_feedback(&feedback_);
    } catch (const std::exception & error) {
      log_exception(error.what());
      return false;
    }
  }

  bool succeed(const Result & result = Result()) noexcept
  {
    return finish_with(GoalStatus::succeeded, result);
  }
  bool abort(const Result & result = Result()) noexcept { return finish_with(GoalStatus::aborted, result); }
  /// Only for a goal that is_canceling() or whose handle_cancel is running. Abort other goals.
  bool canceled(const Result & result = Result()) noexcept
  {
    return finish_with(GoalStatus::canceled, result);
  }

 private:
  bool finish_with(GoalStatus status, const Result & result) noexcept
  {
    try {
      auto response = std::make_shared<typename A::Impl::GetResultService::Response>();
      response->status = static_cast<std::int8_t>(status);
      response->result = result;
      return finish(status, std::move(response));
    } catch (const std::exception & error) {
      log_exception(error.what());
      return false;
    }
  }

  const std::shared_ptr<const GoalRequest> request_;
  std::mutex feedback_mutex_;
  typename A::Impl::FeedbackMessage feedback_;
};

}  // namespace rcl_cxx
