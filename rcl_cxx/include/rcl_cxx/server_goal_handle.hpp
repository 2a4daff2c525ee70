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

/// A goal that a server has accepted. All members are thread-safe, never throw, and may be called after the
/// server is gone.
class ServerGoalHandleBase {
 public:
  /// A goal that has no result yet is aborted with an empty one, and that is logged.
  virtual ~ServerGoalHandleBase();
  ServerGoalHandleBase(const ServerGoalHandleBase &) = delete;
  ServerGoalHandleBase & operator=(const ServerGoalHandleBase &) = delete;

  const GoalUUID & get_goal_id() const noexcept;
  GoalStatus get_status() const noexcept;
  /// It has no result yet. Turns false also if the server or the context ends first.
  bool is_active() const noexcept;
  /// A cancel request has been granted; the goal still waits for its result.
  bool is_canceling() const noexcept;
  /// When it was accepted, nanoseconds since the epoch, ROS time: the stamp that cancel requests compare
  /// with.
  std::int64_t accepted_ns() const noexcept;

 protected:
  explicit ServerGoalHandleBase(std::shared_ptr<detail::ServerGoalImpl> impl);
  bool finish(GoalStatus status, std::shared_ptr<void> result_response) noexcept;
  /// False after the goal's end: then nothing is sent.
  bool send_feedback(void * feedback_message) noexcept;
  void report_exception(const char * what) const noexcept;

 private:
  std::shared_ptr<detail::ServerGoalImpl> impl_;
};

/// See ServerGoalHandleBase. Exactly one of succeed, abort and canceled takes effect: the first. They return
/// whether it was this one; a refused one is logged.
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

  /// To every subscriber of the feedback topic. False, and nothing is sent, after the goal's end.
  bool publish_feedback(const Feedback & feedback) noexcept
  {
    try {
      const std::lock_guard lock(feedback_mutex_);
      feedback_.feedback = feedback;  // into the same message every time: its vectors keep their capacity
      return send_feedback(&feedback_);
    } catch (const std::exception & error) {
      report_exception(error.what());
      return false;
    }
  }

  bool succeed(const Result & result = Result()) noexcept
  {
    return finish_with(GoalStatus::succeeded, result);
  }
  bool abort(const Result & result = Result()) noexcept { return finish_with(GoalStatus::aborted, result); }
  /// Only for a goal that is_canceling() (or whose cancel handler is running): a goal that nobody asked to
  /// cancel cannot be canceled, abort it.
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
      report_exception(error.what());
      return false;
    }
  }

  const std::shared_ptr<const GoalRequest> request_;
  std::mutex feedback_mutex_;
  typename A::Impl::FeedbackMessage feedback_;
};

}  // namespace rcl_cxx
