#pragma once

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <functional>
#include <memory>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_action/rclcpp_action.hpp>
#include <stdexcept>
#include <string>
#include <utility>

/// Helpers of the examples: waits with a time limit, and cancellation by signals.
namespace goal_client {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

/// The last signal that asked the example to cancel its goal; 0: none.
inline std::atomic<int> received_signal{0};

/// Stores signals in `received_signal`. A second signal ends the program at once.
inline void cancel_on_signals()
{
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    std::signal(number, [](int received) {
      received_signal = received;
      std::signal(received, SIG_DFL);
    });
  }
}

/// Spins the node until the future has a value. Throws std::runtime_error after the limit.
template <typename Future>
auto wait_for(const rclcpp::Node::SharedPtr & node, const Future & future, seconds limit,
              const std::string & what)
{
  if (rclcpp::spin_until_future_complete(node, future, limit) != rclcpp::FutureReturnCode::SUCCESS) {
    throw std::runtime_error("no " + what + " within " + std::to_string(limit.count()) +
                             " s: check that the nodes are running");
  }
  return future.get();
}

/// A client of an action of the driver.
template <typename Action>
class GoalClient {
 public:
  using Handle = rclcpp_action::ClientGoalHandle<Action>;
  using Result = typename Handle::WrappedResult;
  using OnFeedback = std::function<void(const typename Action::Feedback &)>;

  /// Throws std::runtime_error if the driver does not serve the action.
  GoalClient(rclcpp::Node::SharedPtr node, const std::string & name)
      : node_(std::move(node)), client_(rclcpp_action::create_client<Action>(node_, name))
  {
    if (!client_->wait_for_action_server(seconds(10))) {
      throw std::runtime_error("the action " + name + " is not available: start the driver first");
    }
  }

  /// Sends the goal and waits for its result. After a signal or the limit, cancels the goal; the result then
  /// arrives at standstill. Throws std::runtime_error if the goal is rejected or the driver ends.
  Result send(const typename Action::Goal & goal, seconds limit, OnFeedback on_feedback = {})
  {
    cancel_on_signals();
    typename rclcpp_action::Client<Action>::SendGoalOptions options;
    if (on_feedback) {
      options.feedback_callback = [on_feedback](auto, const auto & feedback) { on_feedback(*feedback); };
    }
    const auto handle =
        wait_for(node_, client_->async_send_goal(goal, options), seconds(10), "response to the goal");
    if (!handle) {
      throw std::runtime_error(
          "rejected: see the log of command_server or the topic goal_rejections for the reason");
    }
    const auto result = client_->async_get_result(handle);
    const auto end = steady_clock::now() + limit;
    while (received_signal == 0 && steady_clock::now() < end) {
      if (rclcpp::spin_until_future_complete(node_, result, milliseconds(50)) ==
          rclcpp::FutureReturnCode::SUCCESS) {
        return result.get();
      }
      if (!client_->action_server_is_ready()) {
        throw std::runtime_error("the driver ended before the result of the goal");
      }
    }
    client_->async_cancel_goal(handle);
    return wait_for(node_, result, seconds(10), "result of the canceled goal");
  }

 private:
  rclcpp::Node::SharedPtr node_;
  typename rclcpp_action::Client<Action>::SharedPtr client_;
};

/// Prints the outcome and returns the exit code of the example.
template <typename Result>
int report(const Result & wrapped)
{
  const auto & result = *wrapped.result;
  std::printf("\n%s, error_code %d, %s\n", result.success ? "done" : "failed", int{result.error_code},
              result.message.empty() ? "no message" : result.message.c_str());
  return received_signal != 0 ? 128 + received_signal : result.success ? 0 : 1;
}

/// Calls the example and prints its errors. The signal handlers of rclcpp are not installed: they would close
/// the connection to the driver, and the goal could not be canceled anymore.
template <typename Example>
int run(int argc, char ** argv, Example example)
{
  int code = 1;
  try {
    rclcpp::init(argc, argv, rclcpp::InitOptions(), rclcpp::SignalHandlerOptions::None);
    code = example();
  } catch (const std::exception & error) {
    std::fprintf(stderr, "\n%s\n", error.what());
  }
  rclcpp::shutdown();
  return code;
}

}  // namespace goal_client
