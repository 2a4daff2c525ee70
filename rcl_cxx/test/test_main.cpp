#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

namespace {
constexpr int kFirstPort = 32768;  // of domain_coordinator, as kLastDomain
constexpr std::uint16_t kLastDomain = 100;

/// Takes a ROS domain that no other test on this machine uses, as ROS's domain_coordinator does: the process
/// that has bound a port has its domain. The project's test runner does the same and sets the domain in the
/// environment.
void take_own_domain()
{
  for (std::uint16_t domain = 1; domain <= kLastDomain; ++domain) {
    const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = ::htons(static_cast<std::uint16_t>(kFirstPort + domain));
    if (fd >= 0 && ::bind(fd, reinterpret_cast<const sockaddr *>(&address), sizeof(address)) == 0) {
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
