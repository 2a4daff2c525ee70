#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

namespace {
constexpr int kFirstPort = 22119;
constexpr int kLastDomain = 100;

/// A ROS domain that no other test has: whoever listens on its port owns it (as ROS's domain_coordinator
/// does), until the process ends.
void take_own_domain()
{
  for (int domain = 1; domain <= kLastDomain; ++domain) {
    const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(kFirstPort + domain));
    address.sin_addr.s_addr = htonl(INADDR_ANY);
    if (::bind(fd, reinterpret_cast<sockaddr *>(&address), sizeof(address)) == 0) {
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
