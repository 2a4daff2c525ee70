#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>

#include "ros_fixture.hpp"

// In processes of their own (signals_child.cpp): a signal is for a whole process.
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
    told_ = ends[0];
  }
  ~Child() { ::close(told_); }
  Child(const Child &) = delete;
  Child & operator=(const Child &) = delete;

  void wait_until_it_tells() const
  {
    char byte = 0;
    ASSERT_EQ(::read(told_, &byte, 1), 1);
  }
  void send(int signal) const { ::kill(pid_, signal); }
  /// As waitpid() tells it.
  int status_at_its_end() const
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
  int told_ = -1;
};

bool succeeded(int status)
{
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}
}  // namespace

class SignalTest : public testing::TestWithParam<int> {};

TEST_P(SignalTest, ShutsDownAndEndsSpin)
{
  const Child child("spins_until", GetParam() == SIGINT ? "SIGINT" : "SIGTERM");
  child.wait_until_it_tells();
  child.send(GetParam());
  EXPECT_TRUE(succeeded(child.status_at_its_end()));
}

INSTANTIATE_TEST_SUITE_P(Both, SignalTest, testing::Values(SIGINT, SIGTERM));

TEST(EarlySignalTest, IsNotLostBeforeTheContextListens)
{
  const Child child("hears_early_signals", "");
  EXPECT_TRUE(succeeded(child.status_at_its_end()));
}

TEST(SecondSignalTest, HasNoEffectWithinTheGracePeriod)
{
  const Child child("shuts_down_slowly", "60000");
  child.wait_until_it_tells();
  child.send(SIGINT);
  child.wait_until_it_tells();
  child.send(SIGINT);
  child.send(SIGTERM);
  child.send(SIGUSR1);
  EXPECT_TRUE(succeeded(child.status_at_its_end()));
}

TEST(SecondSignalTest, EndsHangingProcessAfterTheGracePeriod)
{
  const Child child("shuts_down_slowly", "-1");
  child.wait_until_it_tells();
  child.send(SIGINT);
  child.wait_until_it_tells();
  child.send(SIGTERM);
  const int status = child.status_at_its_end();
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGTERM);
}
