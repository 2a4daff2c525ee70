#include <gtest/gtest.h>

#include <thread>

#include "motion/arbiter.hpp"

namespace ur_ros_rtde {
namespace {

using namespace std::chrono_literals;

Claim claim(Resource resource, const char * owner = "move_l", const char * id = "3f2a")
{
  return {.resource = resource, .owner = owner, .id = id};
}

Expected<Generation> admit()
{
  return Generation{};
}

Expected<Lease> preempting(Arbiter & arbiter, const Claim & claim, std::chrono::milliseconds timeout,
                           const std::stop_token & stop = {})
{
  return arbiter.acquire_preempting(claim, admit, [] { return false; }, Permit::Clock::now() + timeout, stop);
}

TEST(ArbiterTest, GrantsAResourceToOneHolderAndNamesIt)
{
  Arbiter arbiter;
  const auto first = arbiter.acquire(claim(Resource::motion), admit);
  ASSERT_TRUE(first);
  const auto second = arbiter.acquire(claim(Resource::motion, "move_j", "77"), admit);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::busy);
  EXPECT_NE(second.error().message.find("move_l"), std::string::npos);
  EXPECT_NE(second.error().message.find("3f2a"), std::string::npos);
}

TEST(ArbiterTest, GrantsTheResourceAgainAfterRelease)
{
  Arbiter arbiter;
  {
    const auto lease = arbiter.acquire(claim(Resource::motion), admit);
    ASSERT_TRUE(lease);
    EXPECT_EQ(arbiter.holder(Resource::motion)->claim().owner, "move_l");
  }
  EXPECT_FALSE(arbiter.holder(Resource::motion));
  EXPECT_TRUE(arbiter.acquire(claim(Resource::motion), admit));
}

TEST(ArbiterTest, AllowsMotionAndIoConcurrentlyAndNoneAlways)
{
  Arbiter arbiter;
  const auto motion = arbiter.acquire(claim(Resource::motion), admit);
  const auto io = arbiter.acquire(claim(Resource::io), admit);
  const auto none = arbiter.acquire(claim(Resource::none), admit);
  const auto more = arbiter.acquire(claim(Resource::none), admit);
  EXPECT_TRUE(motion && io && none && more);
}

TEST(ArbiterTest, ExcludesScriptAndMotionMutually)
{
  Arbiter arbiter;
  auto script = arbiter.acquire(claim(Resource::script, "send_script"), admit);
  ASSERT_TRUE(script);
  EXPECT_FALSE(arbiter.acquire(claim(Resource::motion), admit));
  script->release();
  const auto motion = arbiter.acquire(claim(Resource::motion), admit);
  EXPECT_TRUE(motion);
  EXPECT_FALSE(arbiter.acquire(claim(Resource::script), admit));
}

TEST(ArbiterTest, PreemptsTheHolderAndWaits)
{
  Arbiter arbiter;
  std::optional<Lease> held;
  std::jthread leaving;
  std::string reason;
  auto first = claim(Resource::motion);
  first.preempt = [&](const Error & why) {
    reason = why.message;
    leaving = std::jthread([&] { held.reset(); });
  };
  held = std::move(*arbiter.acquire(std::move(first), admit));
  const auto second = preempting(arbiter, claim(Resource::motion, "move_j", "77"), 5s);
  EXPECT_TRUE(second);
  EXPECT_EQ(reason, "preempted by move_j, goal 77");
}

TEST(ArbiterTest, RejectsWhenTheHolderDoesNotReleaseInTime)
{
  Arbiter arbiter;
  int asked = 0;
  auto first = claim(Resource::motion);
  first.preempt = [&](const Error &) { ++asked; };
  const auto held = arbiter.acquire(std::move(first), admit);
  const auto second = preempting(arbiter, claim(Resource::motion, "move_j"), 20ms);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::busy);
  EXPECT_EQ(asked, 1);
}

TEST(ArbiterTest, DoesNotPreemptAHolderWithoutCallback)
{
  Arbiter arbiter;
  const auto held = arbiter.acquire(claim(Resource::motion), admit);
  EXPECT_FALSE(preempting(arbiter, claim(Resource::motion, "move_j"), 10s));
}

TEST(ArbiterTest, PreemptsOnlyItsOwnHolderIfAskedTo)
{
  Arbiter arbiter;
  int asked = 0;
  auto first = claim(Resource::motion, "move_j");
  first.preempt = [&](const Error &) { ++asked; };
  const auto held = arbiter.acquire(std::move(first), admit);
  auto other = claim(Resource::motion, "follow_joint_trajectory");
  other.preempts_only_own = true;
  const auto rejected = preempting(arbiter, other, 10s);
  ASSERT_FALSE(rejected);
  EXPECT_EQ(rejected.error().code, ErrorCode::busy);
  EXPECT_EQ(asked, 0);
  auto own = claim(Resource::motion, "move_j", "77");
  own.preempts_only_own = true;
  EXPECT_FALSE(preempting(arbiter, own, 1ms)) << "the holder stays";
  EXPECT_EQ(asked, 1);
}

TEST(ArbiterTest, RetriesWhileTheCauseOfTheRejectionEnds)
{
  Arbiter arbiter;
  int rejected = 0;
  const auto admitted_the_third_time = [&]() -> Expected<Generation> {
    return ++rejected < 3 ? failure(ErrorCode::busy, "stopping") : Expected<Generation>(Generation{});
  };
  EXPECT_TRUE(arbiter.acquire_preempting(claim(Resource::motion), admitted_the_third_time,
                                         [] { return true; }, Permit::Clock::now() + 10s, {}));
  EXPECT_EQ(rejected, 3);
  rejected = 0;
  EXPECT_FALSE(arbiter.acquire_preempting(claim(Resource::motion), admitted_the_third_time,
                                          [] { return false; }, Permit::Clock::now() + 10s, {}));
  EXPECT_EQ(rejected, 1);
}

/// Between two attempts, a claim still is one that waits: a newer one preempts it.
TEST(ArbiterTest, TheNewestClaimWinsOverOneThatRetries)
{
  Arbiter arbiter;
  std::stop_source older_stops;
  auto older = claim(Resource::motion, "move_j", "1");
  older.preempt = [&](const Error &) { older_stops.request_stop(); };
  const auto is_never_admitted = []() -> Expected<Generation> {
    return failure(ErrorCode::busy, "stopping");
  };
  std::optional<Lease> newer;
  const auto preempt_it = [&] {
    newer = std::move(*preempting(arbiter, claim(Resource::motion, "stop", "2"), 10s));
    return true;
  };
  EXPECT_FALSE(arbiter.acquire_preempting(older, is_never_admitted, preempt_it, Permit::Clock::now() + 10s,
                                          older_stops.get_token()));
  EXPECT_TRUE(older_stops.stop_requested());
  EXPECT_TRUE(*newer);
}

/// A claim that waits has no right to what another one takes between the release and its next look.
class TakenResourceTest : public testing::Test {
 protected:
  TakenResourceTest()
  {
    taking_.preempt = [this](const Error &) {
      ++asked_;
      taken_.reset();
    };
  }
  void take() { taken_ = std::move(*arbiter_.acquire(taking_, admit)); }
  std::string owner() const
  {
    const auto holder = arbiter_.holder(Resource::motion);
    return holder ? holder->claim().owner : "";
  }

  Arbiter arbiter_;
  Claim taking_ = claim(Resource::motion, "move_l", "2");
  std::optional<Lease> taken_;
  int asked_ = 0;
};

TEST_F(TakenResourceTest, IsPreemptedFromTheHolderThatCameAfterTheRelease)
{
  std::optional<Lease> held;
  auto first = claim(Resource::motion, "move_j", "1");
  first.preempt = [&](const Error &) {
    held.reset();
    take();
  };
  held = std::move(*arbiter_.acquire(std::move(first), admit));
  const auto stop = preempting(arbiter_, claim(Resource::motion, "stop", "3"), 10s);
  ASSERT_TRUE(stop) << stop.error().message;
  EXPECT_EQ(asked_, 1);
  EXPECT_EQ(owner(), "stop");
}

TEST_F(TakenResourceTest, IsPreemptedFromTheHolderThatCameBetweenTwoAttempts)
{
  int attempts = 0;
  const auto admitted_the_second_time = [&]() -> Expected<Generation> {
    return ++attempts < 2 ? failure(ErrorCode::busy, "stopping") : Expected<Generation>(Generation{});
  };
  const auto taken_in_between = [this] {
    take();
    return true;
  };
  const auto stop =
      arbiter_.acquire_preempting(claim(Resource::motion, "stop", "3"), admitted_the_second_time,
                                  taken_in_between, Permit::Clock::now() + 10s, {});
  ASSERT_TRUE(stop) << stop.error().message;
  EXPECT_EQ(asked_, 1);
  EXPECT_EQ(owner(), "stop");
}

TEST(ArbiterTest, GrantsAModeDuringAMotionButNotDuringAScript)
{
  Arbiter arbiter;
  const auto motion = arbiter.acquire(claim(Resource::motion), admit);
  {
    const auto mode = arbiter.acquire(claim(Resource::mode, "force_mode_start"), admit);
    EXPECT_TRUE(mode);
    EXPECT_EQ(arbiter.arm_holders().size(), 2U);
    EXPECT_FALSE(arbiter.acquire(claim(Resource::script), admit));
  }
  EXPECT_EQ(arbiter.arm_holders().size(), 1U);
}

/// Force mode would begin with a load or a TCP that is about to change.
TEST(ArbiterTest, ExcludesAModeAndWhatForceModeReliesOnMutually)
{
  Arbiter arbiter;
  Claim setting = claim(Resource::motion, "set_tcp");
  setting.excludes_force_mode = true;
  {
    const auto lease = arbiter.acquire(setting, admit);
    ASSERT_TRUE(lease);
    const auto mode = arbiter.acquire(claim(Resource::mode, "force_mode_start"), admit);
    ASSERT_FALSE(mode);
    EXPECT_NE(mode.error().message.find("set_tcp, goal 3f2a is running"), std::string::npos)
        << mode.error().message;
  }
  const auto mode = arbiter.acquire(claim(Resource::mode, "force_mode"), admit);
  ASSERT_TRUE(mode);
  EXPECT_FALSE(arbiter.acquire(setting, admit));
}

TEST(ArbiterTest, DoesNotGrantWhatIsNotAdmitted)
{
  Arbiter arbiter;
  const auto rejected = arbiter.acquire(claim(Resource::motion), []() -> Expected<Generation> {
    return failure(ErrorCode::protective_stop, "stopped");
  });
  ASSERT_FALSE(rejected);
  EXPECT_EQ(rejected.error().code, ErrorCode::protective_stop);
  EXPECT_FALSE(arbiter.holder(Resource::motion));
}

/// Two claims wait for the same holder: the newer one, a stop for instance, must not come second.
TEST(ArbiterTest, TheNewestOfTwoPreemptingClaimsWins)
{
  Arbiter arbiter;
  auto first = claim(Resource::motion);
  std::atomic<bool> asked{false};
  first.preempt = [&](const Error &) { asked = true; };
  std::optional<Lease> held = std::move(*arbiter.acquire(std::move(first), admit));
  std::stop_source older_stops;
  auto older = claim(Resource::motion, "move_j", "1");
  older.preempt = [&](const Error &) { older_stops.request_stop(); };
  std::optional<bool> older_granted;
  std::jthread waiting(
      [&] { older_granted = preempting(arbiter, older, 20s, older_stops.get_token()).has_value(); });
  while (!asked) {
    std::this_thread::yield();
  }
  std::jthread newer([&] { EXPECT_TRUE(preempting(arbiter, claim(Resource::motion, "stop", "2"), 20s)); });
  waiting.join();
  EXPECT_FALSE(*older_granted);
  held.reset();
}

TEST(ArbiterTest, WaitsForTheHoldersThatAStopHasRevoked)
{
  Arbiter arbiter;
  const auto lease = arbiter.acquire(claim(Resource::motion), admit);
  EXPECT_TRUE(arbiter.wait_for_revoked_holders(0ms)) << "its permit is not revoked";
  arbiter.arm_holders().front()->revoke(Error{ErrorCode::preempted, "a stop"});
  EXPECT_FALSE(arbiter.wait_for_revoked_holders(1ms));
  std::jthread leaving([&] { lease->release(); });
  EXPECT_TRUE(arbiter.wait_for_revoked_holders(20s));
}

TEST(ArbiterTest, MayBeDestroyedBeforeItsLeases)
{
  Lease lease;
  {
    Arbiter arbiter;
    lease = std::move(*arbiter.acquire(claim(Resource::motion), admit));
  }
  EXPECT_TRUE(lease);
  lease.release();
  lease.release();
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
          if (const auto lease = arbiter.acquire(claim(Resource::motion), admit)) {
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
