#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <future>
#include <thread>

#include "../src/signals.hpp"
#include "rcl_cxx/rcl_cxx.hpp"
#include "ros_fixture.hpp"

using rcl_cxx::Context;
using rcl_cxx::ContextOptions;

// In processes of their own: a signal is for a whole process, and one that forks must have no threads yet.
namespace {
constexpr int kStopped = 17;

/// Runs `child` in a forked process, which ends with its result.
pid_t start(const std::function<int(int ready_fd)> & child, int & ready)
{
  int ends[2];
  EXPECT_EQ(::pipe(ends), 0);
  const pid_t pid = ::fork();
  if (pid == 0) {
    ::close(ends[0]);
    ::_exit(child(ends[1]));
  }
  ::close(ends[1]);
  ready = ends[0];
  return pid;
}

void wait_until_ready(int fd)
{
  char byte = 0;
  EXPECT_EQ(::read(fd, &byte, 1), 1);
}

void tell_ready(int fd)
{
  EXPECT_EQ(::write(fd, "r", 1), 1);
}

int wait_for_end(pid_t pid)
{
  int status = 0;
  if (!eventually([&] { return ::waitpid(pid, &status, WNOHANG) == pid; })) {
    ::kill(pid, SIGKILL);
    ::waitpid(pid, &status, 0);
    ADD_FAILURE() << "the process did not end";
  }
  return status;
}
}  // namespace

class ContextSignals : public testing::TestWithParam<int> {};

TEST_P(ContextSignals, shut_down_and_spin_returns)
{
  int ready = -1;
  const pid_t pid = start(
      [](int fd) {
        const auto context = std::make_shared<Context>(std::vector<std::string>{"test"});
        rcl_cxx::Executor executor(context);
        executor.post([fd] { tell_ready(fd); });
        executor.spin();
        return context->shutdown_reason() == (GetParam() == SIGINT ? "SIGINT" : "SIGTERM") ? kStopped : 1;
      },
      ready);
  wait_until_ready(ready);
  ::kill(pid, GetParam());
  const int status = wait_for_end(pid);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), kStopped);
}

INSTANTIATE_TEST_SUITE_P(Both, ContextSignals, testing::Values(SIGINT, SIGTERM));

TEST(EarlySignals, that_come_before_the_context_listens_are_not_lost)
{
  int unused = -1;
  const pid_t pid = start(
      [](int /*ready_fd*/) {
        for (int round = 0; round < 100; ++round) {
          std::promise<int> told;
          auto signal = told.get_future();
          const auto watcher = rcl_cxx::detail::SignalWatcher::instance();
          ::raise(SIGINT);
          std::this_thread::sleep_for(std::chrono::microseconds(10 * round));  // the moment is the variation
          watcher->add([&told](int number) { told.set_value(number); });
          if (signal.wait_for(kLimit) != std::future_status::ready || signal.get() != SIGINT) {
            return 1;
          }
        }
        return kStopped;
      },
      unused);
  const int status = wait_for_end(pid);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), kStopped);
  ::close(unused);
}

namespace {
/// A shutdown that takes until its end is asked for by SIGUSR1, and reports its beginning.
int shut_down_slowly(int fd, std::chrono::milliseconds grace)
{
  // Blocked before any thread exists, so that only sigtimedwait takes it.
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGUSR1);
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
  ContextOptions options;
  options.signal_grace = grace;
  const auto context = std::make_shared<Context>(std::vector<std::string>{"test"}, options);
  context->on_pre_shutdown([&] {
    tell_ready(fd);
    const timespec limit{10, 0};
    while (::sigtimedwait(&set, nullptr, &limit) < 0 && errno == EINTR) {
      // The handler of one of the other signals ran in this thread.
    }
  });
  tell_ready(fd);
  return context->wait_for_shutdown(kLimit) ? kStopped : 1;
}
}  // namespace

TEST(ContextSecondSignal, within_the_grace_does_not_disturb_the_shutdown)
{
  int ready = -1;
  const pid_t pid = start([](int fd) { return shut_down_slowly(fd, std::chrono::minutes(1)); }, ready);
  wait_until_ready(ready);
  ::kill(pid, SIGINT);
  wait_until_ready(ready);
  ::kill(pid, SIGINT);
  ::kill(pid, SIGTERM);
  ::kill(pid, SIGUSR1);
  const int status = wait_for_end(pid);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), kStopped);
}

TEST(ContextSecondSignal, after_the_grace_ends_a_process_that_hangs)
{
  int ready = -1;
  const pid_t pid = start([](int fd) { return shut_down_slowly(fd, std::chrono::milliseconds(-1)); }, ready);
  wait_until_ready(ready);
  ::kill(pid, SIGINT);
  wait_until_ready(ready);
  ::kill(pid, SIGTERM);
  const int status = wait_for_end(pid);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGTERM);
}
