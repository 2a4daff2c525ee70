#include <gtest/gtest.h>

#include <thread>

#include "ur_ros_rtde_robot/motion/arbiter.hpp"

namespace ur_ros_rtde {
namespace {

using namespace std::chrono_literals;

Claim claim(Resource resource, const char * owner = "move_l", const char * id = "3f2a")
{
  return {resource, owner, id, {}};
}

TEST(ArbiterTest, GrantsAResourceToOneHolderAndNamesIt)
{
  Arbiter arbiter;
  const auto first = arbiter.acquire(claim(Resource::motion));
  ASSERT_TRUE(first);
  const auto second = arbiter.acquire(claim(Resource::motion, "move_j", "77"));
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::busy);
  EXPECT_NE(second.error().message.find("move_l"), std::string::npos);
  EXPECT_NE(second.error().message.find("3f2a"), std::string::npos);
}

TEST(ArbiterTest, GrantsTheResourceAgainAfterRelease)
{
  Arbiter arbiter;
  {
    const auto lease = arbiter.acquire(claim(Resource::motion));
    ASSERT_TRUE(lease);
    EXPECT_EQ(arbiter.holder(Resource::motion)->owner, "move_l");
  }
  EXPECT_FALSE(arbiter.holder(Resource::motion));
  EXPECT_TRUE(arbiter.acquire(claim(Resource::motion)));
}

TEST(ArbiterTest, AllowsMotionAndIoConcurrentlyAndNoneAlways)
{
  Arbiter arbiter;
  const auto motion = arbiter.acquire(claim(Resource::motion));
  const auto io = arbiter.acquire(claim(Resource::io));
  const auto none = arbiter.acquire(claim(Resource::none));
  const auto more = arbiter.acquire(claim(Resource::none));
  EXPECT_TRUE(motion && io && none && more);
}

TEST(ArbiterTest, ExcludesScriptAndMotionMutually)
{
  Arbiter arbiter;
  auto script = arbiter.acquire(claim(Resource::script, "send_script"));
  ASSERT_TRUE(script);
  EXPECT_FALSE(arbiter.acquire(claim(Resource::motion)));
  script->release();
  const auto motion = arbiter.acquire(claim(Resource::motion));
  EXPECT_TRUE(motion);
  EXPECT_FALSE(arbiter.acquire(claim(Resource::script)));
}

TEST(ArbiterTest, PreemptsTheHolderAndWaits)
{
  Arbiter arbiter;
  std::optional<Lease> held;
  std::jthread leaving;
  std::string asked_by;
  auto first = claim(Resource::motion);
  first.preempt = [&](const std::string & by) {
    asked_by = by;
    leaving = std::jthread([&] { held.reset(); });
  };
  held = std::move(*arbiter.acquire(std::move(first)));
  const auto second = arbiter.acquire_preempting(claim(Resource::motion, "move_j", "77"), 5s);
  EXPECT_TRUE(second);
  EXPECT_EQ(asked_by, "move_j, goal 77");
}

TEST(ArbiterTest, RefusesWhenTheHolderDoesNotReleaseInTime)
{
  Arbiter arbiter;
  int asked = 0;
  auto first = claim(Resource::motion);
  first.preempt = [&](const std::string &) { ++asked; };
  const auto held = arbiter.acquire(std::move(first));
  const auto second = arbiter.acquire_preempting(claim(Resource::motion, "move_j"), 20ms);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::busy);
  EXPECT_EQ(asked, 1);
}

TEST(ArbiterTest, DoesNotPreemptAHolderWithoutCallback)
{
  Arbiter arbiter;
  const auto held = arbiter.acquire(claim(Resource::motion));
  EXPECT_FALSE(arbiter.acquire_preempting(claim(Resource::motion, "move_j"), 10s));
}

TEST(ArbiterTest, MayBeDestroyedBeforeItsLeases)
{
  Lease lease;
  {
    Arbiter arbiter;
    lease = std::move(*arbiter.acquire(claim(Resource::motion)));
  }
  EXPECT_TRUE(lease);
  lease.release();
  EXPECT_FALSE(lease);
}

TEST(ArbiterTest, GrantsAContestedResourceToExactlyOne)
{
  Arbiter arbiter;
  std::atomic<int> inside{0};
  std::atomic<int> most{0};
  std::atomic<int> got{0};
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 8; ++i) {
      threads.emplace_back([&] {
        for (int n = 0; n < 500; ++n) {
          if (const auto lease = arbiter.acquire(claim(Resource::motion))) {
            const int now = ++inside;
            most = std::max(most.load(), now);
            ++got;
            --inside;
          }
        }
      });
    }
  }
  EXPECT_EQ(most, 1);
  EXPECT_GT(got, 0);
}

}  // namespace
}  // namespace ur_ros_rtde
