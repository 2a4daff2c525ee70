/// A node with topics, services, actions and parameters, for the tests with rclpy (test_*.py).

#include <chrono>
#include <condition_variable>
#include <iostream>
#include <memory>
#include <mutex>
#include <rcl_cxx/rcl_cxx.hpp>
#include <rcl_cxx_test/action_client.hpp>
#include <rcl_cxx_test/action_server.hpp>
#include <rcl_cxx_test/client.hpp>
#include <std_msgs/msg/string.hpp>
#include <std_srvs/srv/set_bool.hpp>
#include <std_srvs/srv/trigger.hpp>
#include <test_msgs/action/fibonacci.hpp>
#include <thread>
#include <vector>

namespace {
using std::chrono::milliseconds;
using std::chrono::seconds;
using Fibonacci = test_msgs::action::Fibonacci;
using Handle = rcl_cxx::TypedGoalHandle<Fibonacci>;
using String = std_msgs::msg::String;

// Orders with a special meaning instead of a number of elements.
constexpr int kRunUntilCanceled = 1000;
constexpr int kRejectCancel = 1001;
constexpr int kSucceedOnCancel = 1002;
constexpr int kAbort = 1003;
constexpr int kDropHandle = 1004;
constexpr int kThrow = 1005;
constexpr int kThrowInGoal = 1006;
constexpr int kFinishTwice = 1007;
constexpr int kCanceledUnasked = 1008;
constexpr int kCancelInHandler = 1009;

// The next element would not fit into its type.
constexpr std::size_t kLongest = 40;

/// Executes each goal in a thread of its own.
class Counting {
 public:
  Counting(rcl_cxx::Node & node, const std::string & name, const rcl_cxx::ActionServerOptions & options = {})
      : logger_(node.get_logger())
  {
    rcl_cxx::TypedCallbacks<Fibonacci> handlers;
    handlers.handle_goal = [](const rcl_cxx::GoalUUID &, const Fibonacci::Goal & goal) {
      return check(goal);
    };
    handlers.handle_accepted = [this](std::shared_ptr<Handle> handle) { start(std::move(handle)); };
    handlers.handle_cancel = [](Handle & handle) { return grant_cancel(handle); };
    handlers.on_canceling = [this](Handle &) { wake_.notify_all(); };
    handlers.on_client_lost = [](Handle & handle) { handle.abort(); };
    server_ = rcl_cxx::create_action_server<Fibonacci>(node, name, std::move(handlers), options);
  }

  ~Counting()
  {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_all();
    for (std::thread & thread : threads_) {
      thread.join();
    }
  }
  Counting(const Counting &) = delete;
  Counting & operator=(const Counting &) = delete;

 private:
  static tl::expected<void, std::string> check(const Fibonacci::Goal & goal)
  {
    if (goal.order == kThrowInGoal) {
      throw std::runtime_error("the goal handler failed");
    }
    if (goal.order < 0) {
      return tl::make_unexpected("order is " + std::to_string(goal.order) + ", it must not be negative");
    }
    return {};
  }

  static bool grant_cancel(Handle & handle)
  {
    if (handle.get_goal().order == kCancelInHandler) {
      handle.canceled();
    }
    return handle.get_goal().order != kRejectCancel;
  }

  void start(std::shared_ptr<Handle> handle)
  {
    if (handle->get_goal().order == kThrow) {
      throw std::runtime_error("the accepted handler failed");
    }
    if (handle->get_goal().order == kDropHandle) {
      return;
    }
    threads_.emplace_back([this, handle = std::move(handle)] { run(*handle); });
  }

  void run(Handle & handle)
  {
    Fibonacci::Feedback progress;
    progress.sequence = {0, 1};
    const int order = handle.get_goal().order;
    for (int i = 2; handle.is_active() && (i < order || order >= kRunUntilCanceled); ++i) {
      if (finish_early(handle, progress) || sleep(handle)) {
        return;
      }
      const auto size = progress.sequence.size();
      if (size < kLongest) {
        progress.sequence.push_back(progress.sequence[size - 1] + progress.sequence[size - 2]);
      }
      handle.publish_feedback(progress);
    }
    handle.succeed(result_of(progress));
  }

  bool finish_early(Handle & handle, const Fibonacci::Feedback & progress)
  {
    const int order = handle.get_goal().order;
    if (handle.is_canceling()) {
      return order == kSucceedOnCancel ? handle.succeed(result_of(progress))
                                       : handle.canceled(result_of(progress));
    }
    if (order == kRejectCancel && progress.sequence.size() == kLongest) {
      return handle.succeed(result_of(progress));
    }
    switch (order) {
      case kAbort:
        return handle.abort(result_of(progress));
      case kFinishTwice:
        handle.succeed(result_of(progress));
        RCL_CXX_INFO(logger_, "second result: {}", handle.abort());
        return true;
      case kCanceledUnasked:
        RCL_CXX_INFO(logger_, "canceled unasked: {}", handle.canceled());
        return handle.abort(result_of(progress));
      default:
        return false;
    }
  }

  /// Returns true if the node stops: the server's destructor aborts the goal.
  bool sleep(Handle & handle)
  {
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, milliseconds(5), [&] { return stopping_ || handle.is_canceling(); });
    return stopping_;
  }

  static Fibonacci::Result result_of(const Fibonacci::Feedback & progress)
  {
    Fibonacci::Result result;
    result.sequence = progress.sequence;
    return result;
  }

  rcl_cxx::Logger logger_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
  rcl_cxx::ActionServer::SharedPtr server_;
};

/// Calls servers of rclpy: each message starts an action or service call in a thread, which publishes its
/// result on the topic `outcome`.
class Caller {
 public:
  explicit Caller(rcl_cxx::Node & node)
      : outcome_(node.create_publisher<String>("outcome", rcl_cxx::QoS::reliable(10))),
        action_(rcl_cxx::create_action_client<Fibonacci>(node, "py_fibonacci")),
        service_(rcl_cxx::create_client<std_srvs::srv::SetBool>(node, "py_set_bool")),
        call_action_(
            node.create_subscription<String>("call_action", rcl_cxx::QoS::reliable(10),
                                             [this](const String & m) { start(&Caller::call_action, m); })),
        call_service_(
            node.create_subscription<String>("call_service", rcl_cxx::QoS::reliable(10),
                                             [this](const String & m) { start(&Caller::call_service, m); }))
  {
  }
  ~Caller()
  {
    for (std::thread & thread : threads_) {
      thread.join();
    }
  }
  Caller(const Caller &) = delete;
  Caller & operator=(const Caller &) = delete;

 private:
  void start(void (Caller::*call)(int), const String & message)
  {
    threads_.emplace_back([this, call, number = std::stoi(message.data)] { (this->*call)(number); });
  }

  void call_action(int order)
  {
    Fibonacci::Goal goal;
    goal.order = order;
    std::size_t feedbacks = 0;
    const auto result =
        action_->send_goal(goal, seconds(3), [&](const Fibonacci::Feedback &) { ++feedbacks; });
    publish(
        result ? fmt::format("{} {} {}", to_string(result->status), result->result.sequence.size(), feedbacks)
               : result.error());
  }

  void call_service(int number)
  {
    std_srvs::srv::SetBool::Request request;
    request.data = number > 0;
    const auto response = service_->call(request, seconds(3));
    publish(response ? response->message : response.error());
  }

  void publish(const std::string & text)
  {
    String message;
    message.data = text;
    outcome_->publish(message);
  }

  std::shared_ptr<rcl_cxx::Publisher<String>> outcome_;
  std::shared_ptr<rcl_cxx::ActionClient<Fibonacci>> action_;
  std::shared_ptr<rcl_cxx::Client<std_srvs::srv::SetBool>> service_;
  std::vector<std::thread> threads_;
  std::shared_ptr<rcl_cxx::Subscription<String>> call_action_;
  std::shared_ptr<rcl_cxx::Subscription<String>> call_service_;
};

void declare_parameters(rcl_cxx::Node & node)
{
  node.declare_parameter("switch", true);
  node.declare_parameter("count", 3,
                         {.description = "how many", .integer_range = rcl_cxx::IntegerRange{0, 10, 1}});
  node.declare_parameter("speed", 0.5,
                         {.description = "in m/s",
                          .additional_constraints = "slow is smooth",
                          .floating_point_range = rcl_cxx::FloatingPointRange{0.0, 3.0}});
  node.declare_parameter("robot.host", "localhost");
  node.declare_parameter("robot.tool.mass", 1.25);
  node.declare_parameter("model", "ur10e", {.read_only = true});
  node.declare_parameter<std::vector<double>>("home", {0.0, -1.57, 0.0});
  node.declare_parameter<std::vector<std::string>>("names", {"a", "b"});
  node.declare_parameter<std::vector<std::int64_t>>("integers", {1, 2});
  node.declare_parameter<std::vector<bool>>("flags", {true, false});
  node.declare_parameter<std::vector<std::uint8_t>>("bytes", {1, 255});
  node.declare_parameter("limit", 0);
}

int run(int argc, char ** argv)
{
  const auto context = std::make_shared<rcl_cxx::Context>(argc, argv);
  const auto node = std::make_shared<rcl_cxx::Node>(context, "test_node");
  declare_parameters(*node);

  const auto latched = node->create_publisher<String>("latched", rcl_cxx::QoS::transient_local());
  String message;
  message.data = "from before";
  latched->publish(message);
  const auto echo = node->create_publisher<String>("echo", rcl_cxx::QoS::reliable(10));
  const auto said = node->create_subscription<String>("say", rcl_cxx::QoS::reliable(10),
                                                      [&](const String & m) { echo->publish(m); });
  const auto set_bool = node->create_service<std_srvs::srv::SetBool>(
      "set_bool",
      [](const std_srvs::srv::SetBool::Request & request, std_srvs::srv::SetBool::Response & response) {
        response.success = request.data;
        response.message = request.data ? "on" : "off";
      });
  const auto failing = node->create_service<std_srvs::srv::Trigger>(
      "failing", [](const std_srvs::srv::Trigger::Request &, std_srvs::srv::Trigger::Response & response) {
        response.message = "half done";
        throw std::runtime_error("the service handler failed");
      });
  const auto log = node->create_service<std_srvs::srv::Trigger>(
      "~/log", [&](const std_srvs::srv::Trigger::Request &, std_srvs::srv::Trigger::Response & response) {
        RCL_CXX_DEBUG(node->get_logger(), "a debug message");
        RCL_CXX_WARN(node->get_logger(), "a warning with {} and 100 %s", 42);
        response.success = true;
      });
  int declared = 0;
  const auto declare = node->create_service<std_srvs::srv::Trigger>(
      "~/declare", [&](const std_srvs::srv::Trigger::Request &, std_srvs::srv::Trigger::Response & response) {
        node->declare_parameter("declared_" + std::to_string(++declared), 5);
        response.success = true;
      });
  Counting counting(*node, "fibonacci");
  rcl_cxx::ActionServerOptions short_lived;
  short_lived.result_timeout = milliseconds(1500);
  Counting forgetful(*node, "forgetful", short_lived);
  rcl_cxx::ActionServerOptions on_demand;
  on_demand.creation_callback_group = node->create_callback_group();
  Counting unused(*node, "on_demand", on_demand);
  Caller caller(*node);

  rcl_cxx::Executor executor(context);
  executor.add_node(node);
  executor.add_callback_group(*on_demand.creation_callback_group);
  std::cout << "ready" << std::endl;
  executor.spin();
  std::cout << "stopped by " << context->shutdown_reason() << std::endl;
  return 0;
}
}  // namespace

int main(int argc, char ** argv)
{
  try {
    return run(argc, argv);
  } catch (const std::exception & error) {
    std::cerr << "test_node: " << error.what() << std::endl;
    return 2;
  }
}
