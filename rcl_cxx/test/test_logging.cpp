#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <string>

#include "ros_fixture.hpp"

namespace {

/// Replaces the standard error by a pipe that is full, as one whose reader has stopped.
class FullConsole {
 public:
  FullConsole() : saved_(::dup(STDERR_FILENO))
  {
    int ends[2];
    EXPECT_EQ(::pipe2(ends, O_CLOEXEC), 0);
    reader_ = ends[0];
    ::dup2(ends[1], STDERR_FILENO);
    ::fcntl(ends[1], F_SETFL, O_NONBLOCK);
    while (::write(ends[1], "x", 1) == 1) {
    }
    ::fcntl(ends[1], F_SETFL, 0);
    ::close(ends[1]);
  }
  ~FullConsole()
  {
    ::dup2(saved_, STDERR_FILENO);
    ::close(saved_);
    ::close(reader_);
  }
  FullConsole(const FullConsole &) = delete;
  FullConsole & operator=(const FullConsole &) = delete;

  /// What is in the pipe.
  std::string read() const
  {
    ::fcntl(reader_, F_SETFL, O_NONBLOCK);
    std::string text;
    char bytes[4096];
    for (ssize_t got = ::read(reader_, bytes, sizeof(bytes)); got > 0;
         got = ::read(reader_, bytes, sizeof(bytes))) {
      text.append(bytes, static_cast<std::size_t>(got));
    }
    return text;
  }

 private:
  int saved_;
  int reader_ = -1;
};

}  // namespace

TEST(LoggingTest, DoesNotWaitForAConsoleThatNobodyReads)
{
  const auto context = make_context();
  const rcl_cxx::Logger logger("test");
  const FullConsole console;
  std::thread writer([&] {
    for (int i = 0; i < 100; ++i) {
      RCL_CXX_INFO(logger, "message {}", i);
    }
  });
  const auto begin = std::chrono::steady_clock::now();
  writer.join();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, kLimit);
  EXPECT_EQ(console.read().find("message"), std::string::npos);
  RCL_CXX_INFO(logger, "read again");
  const std::string text = console.read();
  EXPECT_NE(text.find("100 log messages were not written"), std::string::npos) << text;
  EXPECT_NE(text.find("read again"), std::string::npos) << text;
}
