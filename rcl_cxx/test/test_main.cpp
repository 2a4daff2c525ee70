#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

namespace {
constexpr int kFirstPort = 32768;  // of domain_coordinator, as kLastDomain
constexpr std::uint16_t kLastDomain = 100;
constexpr int kRtpsPort = 7400;  // the first UDP port of domain 0
constexpr int kRtpsPorts = 250;  // of each domain

/// Returns whether a node of the domain runs on this host.
bool has_participants(int domain)
{
  const int first = kRtpsPort + kRtpsPorts * domain;
  for (const char * file : {"/proc/net/udp", "/proc/net/udp6"}) {
    std::ifstream sockets(file);
    std::string rest;
    std::getline(sockets, rest);  // the heading
    for (std::string number, local; sockets >> number >> local && std::getline(sockets, rest);) {
      const int port = std::stoi(local.substr(local.rfind(':') + 1), nullptr, 16);
      if (port >= first && port < first + kRtpsPorts) {
        return true;
      }
    }
  }
  return false;
}

/// Takes a ROS domain that no other test and no running node on this host uses, as support/ros_domain.py
/// does.
void take_own_domain()
{
  for (std::uint16_t domain = kLastDomain; domain > 0; --domain) {
    const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = ::htons(static_cast<std::uint16_t>(kFirstPort + domain));
    if (fd >= 0 && ::bind(fd, reinterpret_cast<const sockaddr *>(&address), sizeof(address)) == 0 &&
        !has_participants(domain)) {
      ::setenv("ROS_DOMAIN_ID", std::to_string(domain).c_str(), 1);
      return;
    }
    ::close(fd);
  }
  std::fputs("all ROS domains are in use\n", stderr);
  std::exit(1);
}

/// Returns whether the value of an environment variable is this one.
bool is(const char * variable, const std::string & value)
{
  const char * found = std::getenv(variable);
  return found != nullptr && found == value;
}

/// Lets this process find the nodes of a domain of its own on this host, and no others. A ROS_DOMAIN_ID of
/// the user is that of a robot.
void isolate()
{
  take_own_domain();
  for (const char * name :
       {"ROS_STATIC_PEERS", "ROS_DISCOVERY_SERVER", "ROS_SUPER_CLIENT", "ROS2_EASY_MODE", "CYCLONEDDS_URI"}) {
    ::unsetenv(name);
  }
  ::setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST", 1);
  if (is("ROS_DISTRO", "humble")) {  // does not know it
    ::setenv("ROS_LOCALHOST_ONLY", "1", 1);
  }
}
}  // namespace

int main(int argc, char ** argv)
{
  const char * reserved = std::getenv("UR_TEST_DOMAIN");  // by `./ur test`
  if (reserved == nullptr || !is("ROS_DOMAIN_ID", reserved)) {
    isolate();
    std::printf("ROS_DOMAIN_ID=%s\n", std::getenv("ROS_DOMAIN_ID"));
  }
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
