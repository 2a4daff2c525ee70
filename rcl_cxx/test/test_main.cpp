#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace {
constexpr int kLastDomain = 101;

/// Takes a ROS domain that no other test on this machine uses, by locking a file until the process ends. The
/// project's test runner does the same and sets the domain in the environment.
void take_own_domain()
{
  const auto folder = std::filesystem::temp_directory_path() / ("ur-domains-" + std::to_string(::getuid()));
  std::filesystem::create_directories(folder);
  for (int domain = 1; domain <= kLastDomain; ++domain) {
    const int fd = ::open((folder / std::to_string(domain)).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (fd >= 0 && ::flock(fd, LOCK_EX | LOCK_NB) == 0) {
      ::setenv("ROS_DOMAIN_ID", std::to_string(domain).c_str(), 1);
      return;
    }
    ::close(fd);
  }
}
}  // namespace

int main(int argc, char ** argv)
{
  ::setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST", 0);
  if (std::getenv("ROS_DOMAIN_ID") == nullptr) {
    take_own_domain();
  }
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
