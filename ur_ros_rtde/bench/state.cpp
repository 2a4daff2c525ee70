// Measures the time from the reception of a package of the controller to the callback of a subscriber of
// joint_states in another process.
//
//     bench_state [seconds] [--ros-args …]        beside a robot_state_receiver or a driver
//
// The stamp of a message is the time at which the node received the package, by the system clock.

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <rcl_cxx/rcl_cxx.hpp>
#include <sensor_msgs/msg/joint_state.hpp>
#include <thread>
#include <vector>

int main(int argc, char ** argv)
{
  auto context = std::make_shared<rcl_cxx::Context>(argc, argv);
  const auto & arguments = context->non_ros_arguments();
  const double duration = arguments.size() > 1 ? std::atof(arguments[1].c_str()) : 10.0;
  rcl_cxx::Node node(context, "bench_state");
  std::vector<double> milliseconds;
  milliseconds.reserve(static_cast<std::size_t>(duration * 1000.0));
  const auto subscription = node.create_subscription<sensor_msgs::msg::JointState>(
      "joint_states", rcl_cxx::QoS::reliable(10),
      [&milliseconds](const sensor_msgs::msg::JointState & message) {
        const auto now = std::chrono::system_clock::now().time_since_epoch();
        const auto stamp = std::chrono::seconds(message.header.stamp.sec) +
                           std::chrono::nanoseconds(message.header.stamp.nanosec);
        milliseconds.push_back(std::chrono::duration<double, std::milli>(now - stamp).count());
      });
  rcl_cxx::Executor executor(context);
  executor.add_node(node);
  executor.spin_until([] { return false; },
                      std::chrono::nanoseconds(static_cast<std::int64_t>(duration * 1e9)));
  if (milliseconds.empty()) {
    fmt::print(stderr, "no message was received on {}\n", subscription->get_topic_name());
    return 1;
  }
  std::sort(milliseconds.begin(), milliseconds.end());
  const auto at = [&](double part) {
    return milliseconds[static_cast<std::size_t>(part * static_cast<double>(milliseconds.size() - 1))];
  };
  fmt::print("package -> subscriber: p50 {:.3f} ms   p99 {:.3f} ms   worst {:.3f} ms   {:.0f} a second\n",
             at(0.5), at(0.99), at(1.0), static_cast<double>(milliseconds.size()) / duration);
  return 0;
}
