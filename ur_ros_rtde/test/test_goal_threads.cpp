#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <future>
#include <memory>
#include <set>
#include <string>
#include <thread>

#include "ur_ros_rtde/detail/goal_threads.hpp"

namespace ur_ros_rtde {
namespace {
using std::chrono::milliseconds;
using std::chrono::seconds;

const StopReason shutdown{ErrorCode::shutdown, "the end"};

/// Waits until it is asked to end.
void wait_for(const StopRequest & stop_request)
{
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  wake.wait(lock, stop_request.token(), [] { return false; });
}

TEST(GoalThreadsTest, RunConcurrently)
{
  GoalThreads threads;
  std::promise<void> first_runs;
  std::promise<void> second_runs;
  auto second_future = second_runs.get_future();
  std::atomic<bool> met{false};
  ASSERT_TRUE(threads.start("first", std::make_shared<StopRequest>(), [&] {
    first_runs.set_value();
    met = second_future.wait_for(seconds(10)) == std::future_status::ready;
  }));
  ASSERT_EQ(first_runs.get_future().wait_for(seconds(10)), std::future_status::ready);
  ASSERT_TRUE(threads.start("second", std::make_shared<StopRequest>(), [&] { second_runs.set_value(); }));
  EXPECT_TRUE(threads.close(shutdown, seconds(10)).empty());
  EXPECT_TRUE(met);
}

TEST(GoalThreadsTest, CloseRequestsAStopWithTheReasonAndWaits)
{
  GoalThreads threads;
  auto stop_request = std::make_shared<StopRequest>();
  std::atomic<bool> ended{false};
  ASSERT_TRUE(threads.start("goal", stop_request, [&] {
    wait_for(*stop_request);
    ended = true;
  }));
  EXPECT_TRUE(threads.close(shutdown, seconds(10)).empty());
  EXPECT_TRUE(ended);
  ASSERT_TRUE(stop_request->reason());
  EXPECT_EQ(stop_request->reason()->code, ErrorCode::shutdown);
}

TEST(GoalThreadsTest, RefuseAfterClose)
{
  GoalThreads threads;
  threads.close(shutdown, milliseconds(0));
  const auto status = threads.start("late", std::make_shared<StopRequest>(), [] { FAIL(); });
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::shutdown);
}

TEST(GoalThreadsTest, ThreadsExecuteFurtherGoals)
{
  GoalThreads threads;
  std::set<std::thread::id> ids;
  constexpr std::size_t count = 60;
  for (std::size_t i = 0; i < count; ++i) {
    std::promise<std::thread::id> id;
    ASSERT_TRUE(threads.start("goal", std::make_shared<StopRequest>(),
                              [&id] { id.set_value(std::this_thread::get_id()); }));
    ids.insert(id.get_future().get());
  }
  EXPECT_LT(ids.size(), count / 2);  // some threads may not wait yet when the next goal starts
}

TEST(GoalThreadsTest, AGoalDoesNotWaitForAThreadThatIsBusy)
{
  GoalThreads threads;
  auto stop_request = std::make_shared<StopRequest>();
  constexpr int count = 20;
  std::atomic<int> met{0};
  std::promise<void> all_run;
  for (int round = 0; round < count; ++round) {
    ASSERT_TRUE(threads.start("goal", stop_request, [&] {
      if (++met == count) {
        all_run.set_value();
      }
      wait_for(*stop_request);
    }));
  }
  EXPECT_EQ(all_run.get_future().wait_for(seconds(10)), std::future_status::ready);
  stop_request->request(shutdown);
}

TEST(GoalThreadsTest, TheWorkOfAGoalIsDestroyedWhenItEnds)
{
  GoalThreads threads;
  auto object = std::make_shared<int>(1);
  const std::weak_ptr<int> observer = object;
  ASSERT_TRUE(threads.start("goal", std::make_shared<StopRequest>(), [object = std::move(object)] {}));
  EXPECT_TRUE(threads.close(shutdown, seconds(10)).empty());
  EXPECT_TRUE(observer.expired());
}

TEST(GoalThreadsTest, CloseNamesThreadsThatDoNotEnd)
{
  GoalThreads threads;
  std::promise<void> release;
  ASSERT_TRUE(threads.start("stubborn", std::make_shared<StopRequest>(),
                            [future = release.get_future().share()] { future.wait(); }));
  EXPECT_EQ(threads.close(shutdown, milliseconds(10)), std::vector<std::string>{"stubborn"});
  release.set_value();
}

TEST(GoalThreadsTest, RefuseAboveTheLimitUntilSomeHaveEnded)
{
  GoalThreads threads;
  auto stop_request = std::make_shared<StopRequest>();
  for (std::size_t i = 0; i < GoalThreads::limit; ++i) {
    ASSERT_TRUE(threads.start("goal", stop_request, [stop_request] { wait_for(*stop_request); }));
  }
  const auto status = threads.can_start();
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::busy);
  stop_request->request(shutdown);
  const auto limit = std::chrono::steady_clock::now() + seconds(10);
  while (!threads.can_start() && std::chrono::steady_clock::now() < limit) {
    std::this_thread::yield();
  }
  EXPECT_TRUE(threads.can_start());
}

TEST(StopRequestTest, KeepsTheFirstReason)
{
  StopRequest stop_request;
  EXPECT_FALSE(stop_request.reason());
  stop_request.request(Error{ErrorCode::canceled, "first"});
  stop_request.request(Error{ErrorCode::preempted, "second"});
  ASSERT_TRUE(stop_request.reason());
  EXPECT_EQ(stop_request.reason()->message, "first");
  EXPECT_TRUE(stop_request.token().stop_requested());
}

}  // namespace
}  // namespace ur_ros_rtde
