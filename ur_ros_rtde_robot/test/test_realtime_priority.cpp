#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <functional>
#include <thread>
#include <utility>

#include "support.hpp"
#include "ur_ros_rtde_robot/connection/realtime_priority.hpp"

namespace ur_ros_rtde::test {
namespace {

constexpr int priority = 20;

/// Runs a function in a separate thread, whose scheduling the test may change.
void in_a_thread(const std::function<void()> & action)
{
  std::jthread(action).join();
}

std::pair<int, int> policy_and_priority()
{
  sched_param now{};
  sched_getparam(0, &now);
  return {sched_getscheduler(0) & ~SCHED_RESET_ON_FORK, now.sched_priority};
}

const std::pair<int, int> ordinary{SCHED_OTHER, 0};
const std::pair<int, int> realtime{SCHED_FIFO, priority};

/// Affects only the calling thread, since capabilities belong to threads.
void give_up_all_capabilities()
{
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, 2> none{};
  ASSERT_EQ(syscall(SYS_capset, &header, none.data()), 0);
}

/// True for root and for users with a limit above 0.
bool allowed()
{
  bool result = false;
  in_a_thread([&] { result = set_realtime_priority(priority).has_value(); });
  return result;
}

TEST(RealtimePriorityTest, AppliesToTheThreadDuringItsLifetime)
{
  if (!allowed()) {
    GTEST_SKIP() << "this host does not permit real-time priorities";
  }
  in_a_thread([] {
    {
      const RealtimePriority lives(priority);
      EXPECT_EQ(policy_and_priority(), realtime);
      std::pair<int, int> of_a_child;
      in_a_thread([&] { of_a_child = policy_and_priority(); });
      EXPECT_EQ(of_a_child, ordinary) << "child threads must not inherit the priority";
    }
    EXPECT_EQ(policy_and_priority(), ordinary);
  });
}

TEST(RealtimePriorityTest, IsInheritedByNewThreads)
{
  if (!allowed()) {
    GTEST_SKIP() << "this host does not permit real-time priorities";
  }
  in_a_thread([] {
    ASSERT_TRUE(set_realtime_priority(priority));
    in_a_thread([] { EXPECT_EQ(policy_and_priority(), realtime); });
  });
}

TEST(RealtimePriorityTest, ZeroChangesNothing)
{
  in_a_thread([] {
    ASSERT_TRUE(set_realtime_priority(0));
    const RealtimePriority none(0);
    EXPECT_EQ(policy_and_priority(), ordinary);
  });
}

TEST(RealtimePriorityTest, IsRejectedWithTheRemedyIfNotPermitted)
{
  const rlimit none{0, 0};
  ASSERT_EQ(setrlimit(RLIMIT_RTPRIO, &none), 0);
  in_a_thread([] {
    give_up_all_capabilities();
    const Status rejected = set_realtime_priority(priority);
    ASSERT_FALSE(rejected);
    EXPECT_NE(rejected.error().message.find("realtime_priority 20"), std::string::npos);
    EXPECT_NE(rejected.error().message.find("limits.conf"), std::string::npos);
    const RealtimePriority lives(priority);
    EXPECT_EQ(policy_and_priority(), ordinary);
  });
}

TEST(RealtimePriorityTest, ReceiverWorksIfNotPermitted)
{
  const rlimit none{0, 0};
  ASSERT_EQ(setrlimit(RLIMIT_RTPRIO, &none), 0);
  Controller controller(Controller::options());
  Log log;
  in_a_thread([&] {
    give_up_all_capabilities();
    auto options = receiver_options();
    options.realtime_priority = priority;
    StateReceiver receiver(options, log.function());
    receiver.start();
    EXPECT_TRUE(eventually([&] { return receiver.link().connected && receiver.latest(); })) << log.text();
    EXPECT_EQ(log.count("realtime_priority 20 is not permitted"), 1U) << log.text();
  });
}

}  // namespace
}  // namespace ur_ros_rtde::test
