// Neither ur_rtde nor the driver may allocate memory between the arrival of a package and the publication of
// its messages.

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>
#include <ur_rtde/robot_state.h>
#include <ur_rtde/rtde_receive_interface.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <memory>
#include <rcl_cxx/rcl_cxx.hpp>
#include <string>
#include <thread>
#include <ur_simulator/simulated_controller.hpp>
#include <vector>

#include "counting_malloc.hpp"
#include "nodes/robot_state_receiver.hpp"
#include "ur_ros_rtde_robot/state/state_receiver.hpp"

namespace ur_ros_rtde {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using test::allocations_of_this_thread;

constexpr std::size_t warm_up = 300;  // packages, in which buffers grow to their final size
constexpr std::size_t measured = 500;

/// The loopback address of this test.
std::string address()
{
  const char * given = std::getenv("UR_TEST_ADDRESS");
  return given != nullptr ? given : "127.14.3.7";
}

bool eventually(const std::function<bool()> & condition)
{
  const auto deadline = std::chrono::steady_clock::now() + 30s;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) {
      return false;
    }
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

/// Counts the allocations of a thread from one package to the next.
class Packages {
 public:
  Packages() { allocations_.reserve(warm_up + measured); }

  /// Called in the receiving thread, once per package.
  void add()
  {
    const std::size_t now = allocations_of_this_thread();
    if (size_ > 0 && !complete()) {
      allocations_.push_back(now - before_);
    }
    before_ = now;
    ++size_;
  }
  bool complete() const { return size_ > warm_up + measured; }

  /// The median of the measured packages. Two packages that are read together need a larger buffer.
  std::size_t allocations() const
  {
    std::vector<std::size_t> sorted(allocations_.begin() + warm_up, allocations_.end());
    std::nth_element(sorted.begin(), sorted.begin() + measured / 2, sorted.end());
    return sorted[measured / 2];
  }

 private:
  std::atomic<std::size_t> size_{0};
  std::size_t before_ = 0;
  std::vector<std::size_t> allocations_;
};

/// Subscribes to topics in a process of its own: within one process, the middleware runs the subscriber's
/// code in the publisher's thread. Construct it before ROS is initialized.
class SubscriberProcess {
 public:
  SubscriberProcess()
  {
    EXPECT_EQ(::pipe(ends_), 0);
    process_ = ::fork();
    if (process_ == 0) {
      subscribe(ends_[1]);
    }
  }
  ~SubscriberProcess()
  {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
    ::close(ends_[0]);
    ::close(ends_[1]);
  }
  SubscriberProcess(const SubscriberProcess &) = delete;
  SubscriberProcess & operator=(const SubscriberProcess &) = delete;

  /// Returns whether a message of each topic has been received within 30 s.
  bool receives() const
  {
    pollfd waiting{ends_[0], POLLIN, 0};
    return ::poll(&waiting, 1, 30'000) == 1;
  }

 private:
  [[noreturn]] static void subscribe(int pipe)
  {
    auto context = std::make_shared<rcl_cxx::Context>(std::vector<std::string>{"package_subscriber"});
    rcl_cxx::Node node(context, "package_subscriber");
    int joints = 0, targets = 0, speeds = 0;
    const rcl_cxx::QoS qos = rcl_cxx::QoS::reliable(10);
    const auto one = node.create_subscription<sensor_msgs::msg::JointState>("joint_states", qos,
                                                                            [&](const auto &) { ++joints; });
    const auto two = node.create_subscription<sensor_msgs::msg::JointState>("target_joint_states", qos,
                                                                            [&](const auto &) { ++targets; });
    const auto three = node.create_subscription<geometry_msgs::msg::TwistStamped>(
        "tcp_speed", qos, [&](const auto &) { ++speeds; });
    rcl_cxx::Executor executor(context);
    executor.add_node(node);
    executor.spin_until([&] { return joints > 0 && targets > 0 && speeds > 0; }, 60s);
    const char done = 1;
    const bool told = ::write(pipe, &done, 1) == 1;
    executor.spin_until([&] { return !told; }, 60s);
    ::_exit(0);
  }

  int ends_[2] = {-1, -1};
  pid_t process_ = -1;
};

/// The allocations of ur_rtde per package, without the driver.
std::size_t allocations_of_ur_rtde()
{
  Packages packages;
  ur_rtde::RTDEReceiveInterface bare(address(), 500.0, {}, false, false);
  bare.getRobotState()->setPackageCallback([&] { packages.add(); });
  EXPECT_TRUE(eventually([&] { return packages.complete(); }));
  bare.getRobotState()->setPackageCallback({});
  return packages.complete() ? packages.allocations() : 0;
}

StateReceiverOptions receiver_options()
{
  StateReceiverOptions options;
  options.address = address();
  options.frequency = 500.0;
  options.silence_limit = 5s;  // other tests may keep this machine busy
  return options;
}

TEST(PackagePathTest, DoesNotAllocate)
{
  if (!test::allocations_are_counted) {
    GTEST_SKIP() << "this build cannot count allocations";
  }
  const SubscriberProcess subscriber;
  ur_simulator::SimulatorOptions simulated;
  simulated.address = address();
  const ur_simulator::SimulatedController controller(simulated);
  const std::size_t library = allocations_of_ur_rtde();

  auto context = std::make_shared<rcl_cxx::Context>(std::vector<std::string>{"test_package_path"});
  rcl_cxx::Node node(context, "test_package_path");
  StateReceiver source(receiver_options());
  RobotStateReceiver::Options options;
  options.address = address();
  RobotStateReceiver receiver(
      node, options, [&] { return StateSource{source.link(), source.version(), source.frequency()}; });
  Packages packages;
  std::atomic<bool> counting{false};
  std::atomic<std::size_t> publishing{0};
  source.on_sample([&](const Sample & sample) {
    const std::size_t before = allocations_of_this_thread();
    receiver.publish(sample);
    if (counting) {
      publishing += allocations_of_this_thread() - before;
      packages.add();
    }
  });
  source.start();
  ASSERT_TRUE(subscriber.receives()) << source.link().error.message;
  counting = true;
  ASSERT_TRUE(eventually([&] { return packages.complete(); })) << source.link().error.message;
  source.stop();
  EXPECT_EQ(library, 0U);
  EXPECT_EQ(publishing, 0U);
  EXPECT_EQ(packages.allocations(), 0U);
}

}  // namespace
}  // namespace ur_ros_rtde
