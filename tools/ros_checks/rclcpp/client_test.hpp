#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_action/rclcpp_action.hpp>
#include <sensor_msgs/msg/joint_state.hpp>
#include <string>
#include <thread>
#include <vector>

using namespace std::chrono_literals;

constexpr auto reply_limit = 10s;
constexpr auto motion_limit = 30s;

/// Waits for a condition that another thread changes. Returns false after the limit.
inline bool eventually(const std::function<bool()> & condition, std::chrono::nanoseconds limit = reply_limit)
{
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) {
      return false;
    }
    std::this_thread::sleep_for(2ms);
  }
  return true;
}

template <typename Future>
auto value_of(Future future, std::chrono::nanoseconds limit = reply_limit)
{
  if (future.wait_for(limit) != std::future_status::ready) {
    throw std::runtime_error("no reply within the limit");
  }
  return future.get();
}

/// Keeps the messages of a subscription. May be destroyed while the executor spins.
template <typename Message>
class MessageCollector {
 public:
  MessageCollector(rclcpp::Node & node, const std::string & topic, const rclcpp::QoS & qos)
      : subscription_(node.create_subscription<Message>(
            topic, qos, [state = state_](typename Message::ConstSharedPtr message) {
              const std::lock_guard lock(state->mutex);
              state->messages.push_back(std::move(message));
            }))
  {
  }

  std::vector<typename Message::ConstSharedPtr> messages() const
  {
    const std::lock_guard lock(state_->mutex);
    return state_->messages;
  }
  std::size_t count() const
  {
    const std::lock_guard lock(state_->mutex);
    return state_->messages.size();
  }
  typename Message::ConstSharedPtr newest() const
  {
    const std::lock_guard lock(state_->mutex);
    return state_->messages.empty() ? nullptr : state_->messages.back();
  }

 private:
  struct State {
    std::mutex mutex;
    std::vector<typename Message::ConstSharedPtr> messages;
  };
  const std::shared_ptr<State> state_ = std::make_shared<State>();
  typename rclcpp::Subscription<Message>::SharedPtr subscription_;
};

/// The state of the arm according to `joint_states`.
class Arm {
 public:
  explicit Arm(rclcpp::Node & node) : states_(node, "joint_states", rclcpp::SensorDataQoS()) {}

  sensor_msgs::msg::JointState::ConstSharedPtr newest() const { return states_.newest(); }
  /// Returns the speed of the fastest joint, rad/s.
  double speed() const
  {
    double fastest = 0.0;
    if (const auto state = newest()) {
      for (const double velocity : state->velocity) {
        fastest = std::max(fastest, std::abs(velocity));
      }
    }
    return fastest;
  }
  bool at_rest() const { return newest() && speed() < 0.01; }
  bool at(const std::vector<double> & positions) const
  {
    const auto state = newest();
    return state && std::equal(positions.begin(), positions.end(), state->position.begin(),
                               [](double a, double b) { return std::abs(a - b) < 0.002; });
  }

 private:
  MessageCollector<sensor_msgs::msg::JointState> states_;
};

/// A node with an executor that spins in a thread.
class ClientTest : public ::testing::Test {
 protected:
  ClientTest()
  {
    executor.add_node(node);
    thread = std::thread([this] { executor.spin(); });
  }
  ~ClientTest() override
  {
    eventually([this] { return executor.is_spinning(); });
    executor.cancel();
    thread.join();
  }

  std::shared_ptr<rclcpp::Node> node = std::make_shared<rclcpp::Node>("rclcpp_checks");
  rclcpp::executors::SingleThreadedExecutor executor;
  std::thread thread;
};

/// A goal of an action, from its request to its result.
template <typename Action>
class SentGoal {
 public:
  using Handle = rclcpp_action::ClientGoalHandle<Action>;
  using ClientPtr = typename rclcpp_action::Client<Action>::SharedPtr;

  SentGoal(ClientPtr client, const typename Action::Goal & goal) : client_(std::move(client))
  {
    typename rclcpp_action::Client<Action>::SendGoalOptions options;
    options.feedback_callback = [this](typename Handle::SharedPtr,
                                       const std::shared_ptr<const typename Action::Feedback> feedback) {
      const std::lock_guard lock(mutex_);
      feedback_.push_back(*feedback);
    };
    handle_ = value_of(client_->async_send_goal(goal, options));
  }
  ~SentGoal()
  {
    if (handle_) {
      client_->stop_callbacks(handle_);
    }
  }
  SentGoal(const SentGoal &) = delete;
  SentGoal & operator=(const SentGoal &) = delete;

  bool accepted() const { return handle_ != nullptr; }
  const typename Handle::SharedPtr & handle() const { return handle_; }
  std::vector<typename Action::Feedback> feedback() const
  {
    const std::lock_guard lock(mutex_);
    return feedback_;
  }
  typename Handle::WrappedResult result(std::chrono::nanoseconds limit = motion_limit)
  {
    return value_of(client_->async_get_result(handle_), limit);
  }

 private:
  const ClientPtr client_;
  typename Handle::SharedPtr handle_;
  mutable std::mutex mutex_;
  std::vector<typename Action::Feedback> feedback_;
};

template <typename Action>
typename rclcpp_action::Client<Action>::SharedPtr action_client(const rclcpp::Node::SharedPtr & node,
                                                                const std::string & name)
{
  auto client = rclcpp_action::create_client<Action>(node, name);
  if (!client->wait_for_action_server(reply_limit)) {
    throw std::runtime_error("no action server of " + name);
  }
  return client;
}
