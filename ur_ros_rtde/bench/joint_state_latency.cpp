// Prints, for each message of joint_states, its stamp and when it was received: ns since the epoch, by the
// host's clock.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sensor_msgs/msg/joint_state.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "rcl_cxx/rcl_cxx.hpp"

namespace {

/// After the first message, which may arrive while the node still discovers the other topics of the driver.
constexpr std::chrono::seconds discovery_time{1};

std::int64_t nanoseconds(std::chrono::system_clock::time_point time)
{
  return std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
}

}  // namespace

int main(int argc, char ** argv)
{
  const int seconds = argc > 1 ? std::atoi(argv[1]) : 0;
  if (seconds < 1 || seconds > 600) {
    std::fprintf(stderr, "usage: joint_state_latency SECONDS (1 to 600) [reliable] [--ros-args ...]\n");
    return 2;
  }
  const bool reliable = argc > 2 && std::string_view(argv[2]) == "reliable";
  auto context = std::make_shared<rcl_cxx::Context>(argc, argv);
  rcl_cxx::Node node(context, "joint_state_latency");
  rcl_cxx::Executor executor(context);
  executor.add_node(node);
  std::vector<std::pair<std::int64_t, std::int64_t>> received;
  received.reserve(static_cast<std::size_t>(seconds) * 600);
  const auto subscription = node.create_subscription<sensor_msgs::msg::JointState>(
      "joint_states", reliable ? rcl_cxx::QoS::reliable(10) : rcl_cxx::QoS::sensor_data(),
      [&](const sensor_msgs::msg::JointState & message) {
        const auto & stamp = message.header.stamp;
        received.emplace_back(std::int64_t{stamp.sec} * 1'000'000'000 + stamp.nanosec,
                              nanoseconds(std::chrono::system_clock::now()));
      });
  executor.spin_until([&] { return !received.empty(); }, std::chrono::seconds(15));
  executor.spin_until([] { return false; }, discovery_time);
  received.clear();
  executor.spin_until([] { return false; }, std::chrono::seconds(seconds));
  for (const auto & [stamp, when] : received) {
    std::printf("%lld %lld\n", static_cast<long long>(stamp), static_cast<long long>(when));
  }
  return 0;
}
