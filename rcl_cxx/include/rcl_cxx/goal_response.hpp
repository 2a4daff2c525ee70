#pragma once

#include <functional>
#include <string>
#include <tl/expected.hpp>
#include <variant>

namespace rcl_cxx {

/// The response to a goal request: accepts the goal, or rejects it with a reason, which is logged.
using GoalResponse = tl::expected<void, std::string>;

/// Sends the response to one goal request. May be called from any thread; only the first call has an effect.
using SendGoalResponse = std::function<void(GoalResponse)>;

/// Postpones the response to a goal request whose check takes time: the executor goes on with other requests.
/// The server calls `start` once, in the executor's thread; it must return soon. A goal whose
/// SendGoalResponse is destroyed without a call is rejected. The goal can be canceled, by a request to cancel
/// all goals, before it is accepted; it is then rejected.
struct DeferredGoalResponse {
  std::function<void(SendGoalResponse)> start;
};

using GoalDecision = std::variant<GoalResponse, DeferredGoalResponse>;

}  // namespace rcl_cxx
