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

TEST(Arbiter, gives_a_resource_to_one_at_a_time_and_names_who_has_it)
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

TEST(Arbiter, gives_the_resource_on_when_the_lease_ends)
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

TEST(Arbiter, lets_motion_and_io_go_side_by_side_and_none_beside_everything)
{
  Arbiter arbiter;
  const auto motion = arbiter.acquire(claim(Resource::motion));
  const auto io = arbiter.acquire(claim(Resource::io));
  const auto none = arbiter.acquire(claim(Resource::none));
  const auto more = arbiter.acquire(claim(Resource::none));
  EXPECT_TRUE(motion && io && none && more);
}

TEST(Arbiter, keeps_a_script_and_a_motion_apart)
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

TEST(Arbiter, asks_the_holder_to_give_way_and_waits_for_it)
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

TEST(Arbiter, refuses_when_the_holder_does_not_give_way_in_time)
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

TEST(Arbiter, does_not_ask_a_holder_that_never_gives_way)
{
  Arbiter arbiter;
  const auto held = arbiter.acquire(claim(Resource::motion));
  EXPECT_FALSE(arbiter.acquire_preempting(claim(Resource::motion, "move_j"), 10s));
}

TEST(Arbiter, may_be_gone_before_its_leases)
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

TEST(Arbiter, gives_a_contested_resource_to_exactly_one)
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
