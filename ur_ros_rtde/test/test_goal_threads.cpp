#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <condition_variable>
#include <fstream>
#include <functional>
#include <future>
#include <string>
#include <thread>

#include "ur_ros_rtde/detail/goal_threads.hpp"

namespace ur_ros_rtde {
namespace {
using std::chrono::milliseconds;
using std::chrono::seconds;

const StopReason shutdown{ErrorCode::shutdown, "the end"};

/// What a thread does when its function has returned.
struct AtThreadExit {
  ~AtThreadExit() { action(); }
  std::function<void()> action;
};

/// Waits until a thread of this process waits for something.
void wait_until_asleep(pid_t thread)
{
  const std::string file = "/proc/self/task/" + std::to_string(thread) + "/stat";
  std::string id, name, state;
  while (state != "S" && std::ifstream(file) >> id >> name >> state) {
  }
}

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

TEST(GoalThreadsTest, RefuseWhenClosedDuringAJoin)
{
  GoalThreads threads;
  std::promise<void> release;
  std::promise<void> leaving;
  ASSERT_TRUE(threads.start("finished", std::make_shared<StopRequest>(), [&] {
    static thread_local AtThreadExit at_exit;
    at_exit.action = [&] {
      leaving.set_value();
      release.get_future().wait();
    };
  }));
  leaving.get_future().wait();
  std::promise<pid_t> id;
  Status status;
  std::thread starter([&] {
    id.set_value(::gettid());
    status = threads.start("late", std::make_shared<StopRequest>(), [] { FAIL(); });
  });
  wait_until_asleep(id.get_future().get());
  threads.close(shutdown, milliseconds(0));
  release.set_value();
  starter.join();
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::shutdown);
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
