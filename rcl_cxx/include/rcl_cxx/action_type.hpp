#pragma once

#include <cstdint>
#include <memory>
#include <rosidl_typesupport_cpp/action_type_support.hpp>

#include "rcl_cxx/goal_uuid.hpp"

namespace rcl_cxx {

/// Creates messages of a type that the caller does not know.
struct MessageType {
  void * (*create)();
  void (*destroy)(void *);
};

template <typename M>
constexpr MessageType message_type()
{
  return {[]() -> void * { return new M(); }, [](void * message) { delete static_cast<M *>(message); }};
}

std::shared_ptr<void> make_message(const MessageType & type);

/// What an action server has to know about the types of an action. The server itself is compiled once for all
/// actions; otherwise a hundred actions would mean a hundred copies to compile and link. In the parameters,
/// `request`, `response` and `message` are the messages of the same names that rosidl generates; `goal`,
/// `result` and `feedback` are A::Goal, A::Result and A::Feedback.
struct ActionType {
  const rosidl_action_type_support_t * (*type_support)();
  MessageType goal_request;
  MessageType goal_response;
  MessageType result_request;
  MessageType result_response;
  MessageType feedback_message;

  GoalUUID (*get_goal_id)(const void * goal_request);
  const void * (*get_goal)(const void * goal_request);
  void (*set_goal_response)(void * response, bool accepted, std::int64_t stamp_ns);
  GoalUUID (*get_goal_id_of_result_request)(const void * result_request);
  void * (*get_result)(void * result_response);
  void (*set_status)(void * result_response, GoalStatus status);
  void (*copy_result)(void * result_response, const void * result);
  void (*set_goal_id)(void * feedback_message, const GoalUUID & id);
  void (*copy_feedback)(void * feedback_message, const void * feedback);
};

namespace detail {
/// The functions of ActionType for the messages of `A`.
template <typename A>
struct ActionMessages {
  using GoalRequest = typename A::Impl::SendGoalService::Request;
  using GoalResponse = typename A::Impl::SendGoalService::Response;
  using ResultRequest = typename A::Impl::GetResultService::Request;
  using ResultResponse = typename A::Impl::GetResultService::Response;
  using FeedbackMessage = typename A::Impl::FeedbackMessage;

  static GoalUUID get_goal_id(const void * request)
  {
    return GoalUUID{static_cast<const GoalRequest *>(request)->goal_id.uuid};
  }
  static const void * get_goal(const void * request)
  {
    return &static_cast<const GoalRequest *>(request)->goal;
  }
  static void set_goal_response(void * response, bool accepted, std::int64_t stamp_ns)
  {
    constexpr std::int64_t ns_per_second = 1'000'000'000;
    auto & message = *static_cast<GoalResponse *>(response);
    message.accepted = accepted;
    message.stamp.sec = static_cast<std::int32_t>(stamp_ns / ns_per_second);
    message.stamp.nanosec = static_cast<std::uint32_t>(stamp_ns % ns_per_second);
  }
  static GoalUUID get_goal_id_of_result_request(const void * request)
  {
    return GoalUUID{static_cast<const ResultRequest *>(request)->goal_id.uuid};
  }
  static void * get_result(void * response) { return &static_cast<ResultResponse *>(response)->result; }
  static void set_status(void * response, GoalStatus status)
  {
    static_cast<ResultResponse *>(response)->status = static_cast<std::int8_t>(status);
  }
  static void copy_result(void * response, const void * result)
  {
    static_cast<ResultResponse *>(response)->result = *static_cast<const typename A::Result *>(result);
  }
  static void set_goal_id(void * message, const GoalUUID & id)
  {
    static_cast<FeedbackMessage *>(message)->goal_id.uuid = id.bytes;
  }
  static void copy_feedback(void * message, const void * feedback)
  {
    static_cast<FeedbackMessage *>(message)->feedback = *static_cast<const typename A::Feedback *>(feedback);
  }
};
}  // namespace detail

template <typename A>
const ActionType & action_type()
{
  using Messages = detail::ActionMessages<A>;
  static constexpr ActionType type{.type_support = &rosidl_typesupport_cpp::get_action_type_support_handle<A>,
                                   .goal_request = message_type<typename Messages::GoalRequest>(),
                                   .goal_response = message_type<typename Messages::GoalResponse>(),
                                   .result_request = message_type<typename Messages::ResultRequest>(),
                                   .result_response = message_type<typename Messages::ResultResponse>(),
                                   .feedback_message = message_type<typename Messages::FeedbackMessage>(),
                                   .get_goal_id = &Messages::get_goal_id,
                                   .get_goal = &Messages::get_goal,
                                   .set_goal_response = &Messages::set_goal_response,
                                   .get_goal_id_of_result_request = &Messages::get_goal_id_of_result_request,
                                   .get_result = &Messages::get_result,
                                   .set_status = &Messages::set_status,
                                   .copy_result = &Messages::copy_result,
                                   .set_goal_id = &Messages::set_goal_id,
                                   .copy_feedback = &Messages::copy_feedback};
  return type;
}

}  // namespace rcl_cxx
