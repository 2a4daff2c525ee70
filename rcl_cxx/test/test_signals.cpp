#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>

#include "ros_fixture.hpp"

// The signals are sent to a process of their own (signals_child.cpp).
namespace {

class Child {
 public:
  Child(const std::string & part, const std::string & argument)
  {
    int ends[2];
    EXPECT_EQ(::pipe(ends), 0);
    pid_ = ::fork();
    if (pid_ == 0) {
      ::dup2(ends[1], STDOUT_FILENO);
      ::close(ends[0]);
      ::close(ends[1]);
      ::execl(SIGNALS_CHILD, "signals_child", part.c_str(), argument.c_str(), nullptr);
      ::_exit(127);
    }
    ::close(ends[1]);
    reports_ = ends[0];
  }
  ~Child() { ::close(reports_); }
  Child(const Child &) = delete;
  Child & operator=(const Child &) = delete;

  void wait_for_report() const
  {
    char byte = 0;
    ASSERT_EQ(::read(reports_, &byte, 1), 1);
  }
  void send(int signal) const { ::kill(pid_, signal); }
  /// The status of waitpid().
  int wait_for_exit() const
  {
    int status = 0;
    if (!eventually([&] { return ::waitpid(pid_, &status, WNOHANG) == pid_; })) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, &status, 0);
      ADD_FAILURE() << "the process did not end";
    }
    return status;
  }

 private:
  pid_t pid_ = -1;
  int reports_ = -1;
};

bool succeeded(int status)
{
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}
}  // namespace

class SignalTest : public testing::TestWithParam<int> {};

TEST_P(SignalTest, ShutsDownAndEndsSpin)
{
  const Child child("spins_until", GetParam() == SIGINT    ? "SIGINT"
                                   : GetParam() == SIGTERM ? "SIGTERM"
                                                           : "SIGHUP");
  child.wait_for_report();
  child.send(GetParam());
  EXPECT_TRUE(succeeded(child.wait_for_exit()));
}

INSTANTIATE_TEST_SUITE_P(All, SignalTest, testing::Values(SIGINT, SIGTERM, SIGHUP));

TEST(EarlySignalTest, IsNotLostBeforeTheContextListens)
{
  const Child child("hears_early_signals", "");
  EXPECT_TRUE(succeeded(child.wait_for_exit()));
}

TEST(SecondSignalTest, HasNoEffectWithinTheGracePeriod)
{
  const Child child("shuts_down_slowly", "60000");
  child.wait_for_report();
  child.send(SIGINT);
  child.wait_for_report();
  child.send(SIGINT);
  child.send(SIGTERM);
  child.send(SIGUSR1);
  EXPECT_TRUE(succeeded(child.wait_for_exit()));
}

TEST(SecondSignalTest, EndsHangingProcessAfterTheGracePeriod)
{
  const Child child("shuts_down_slowly", "-1");
  child.wait_for_report();
  child.send(SIGINT);
  child.wait_for_report();
  child.send(SIGTERM);
  const int status = child.wait_for_exit();
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGTERM);
}
