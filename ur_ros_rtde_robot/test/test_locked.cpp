#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "ur_ros_rtde_robot/connection/locked.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {
namespace {

using namespace std::chrono_literals;

struct Counter {
  int value = 0;
  int inside = 0;
  int most_inside = 0;
  int add(int amount = 1)
  {
    most_inside = std::max(most_inside, ++inside);
    std::this_thread::yield();
    --inside;
    return value += amount;
  }
};

struct LockedTest : testing::Test {
  std::shared_ptr<Counter> counter = std::make_shared<Counter>();
  std::shared_ptr<InterfaceLock> lock = std::make_shared<InterfaceLock>();
  Locked<Counter> locked(std::chrono::milliseconds timeout = 5s)
  {
    return {counter, lock, "counter", timeout};
  }
};

TEST_F(LockedTest, SerializesCalls)
{
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([this] {
        for (int n = 0; n < 1000; ++n) {
          locked()->add();
        }
      });
    }
  }
  EXPECT_EQ(counter->value, 4000);
  EXPECT_EQ(counter->most_inside, 1);
}

TEST_F(LockedTest, DoesNotStarveAThreadWhileAnotherCallsInALoop)
{
  std::atomic<bool> done{false};
  std::jthread greedy([&] {
    while (!done) {
      locked()->add();
    }
  });
  for (int i = 0; i < 100; ++i) {
    EXPECT_NO_THROW(locked()->add());
  }
  done = true;
}

TEST_F(LockedTest, IsRecursive)
{
  EXPECT_EQ(locked()->add(locked()->add(2)), 4);
}

TEST_F(LockedTest, RejectsAfterTheLimitWhileAnotherThreadHoldsTheLock)
{
  const auto held = locked().hold();
  std::jthread([this] {
    try {
      locked(20ms)->add();
      ADD_FAILURE() << "the lock was not available";
    } catch (const RobotError & error) {
      EXPECT_EQ(error.error().code, ErrorCode::busy);
      EXPECT_NE(error.error().message.find("counter"), std::string::npos);
    }
  }).join();
  held->add();
  EXPECT_EQ(counter->value, 1);
}

TEST_F(LockedTest, ReleasesTheLockWhenTheCallThrows)
{
  struct Thrower {
    void fail() { throw std::runtime_error("no"); }
  };
  const Locked<Thrower> thrower(std::make_shared<Thrower>(), lock, "thrower");
  EXPECT_THROW(thrower->fail(), std::runtime_error);
  std::jthread([this] { EXPECT_EQ(locked(1s)->add(), 1); }).join();
}

TEST_F(LockedTest, KeepsTheObjectAlive)
{
  auto use = locked();
  counter.reset();
  EXPECT_EQ(use->add(), 1);
}

}  // namespace
}  // namespace ur_ros_rtde
