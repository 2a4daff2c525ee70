#include <dlfcn.h>
#include <gtest/gtest.h>
#include <netdb.h>

#include <atomic>
#include <string_view>

#include "connection/dashboard_request.hpp"
#include "connection/ports.hpp"
#include "support.hpp"
#include "ur_ros_rtde_robot/connection/tcp_socket.hpp"

namespace {
/// Host names with this ending resolve to the test's controller.
constexpr std::string_view domain = ".test";
std::atomic<bool> name_server_answers{true};
}  // namespace

extern "C" int getaddrinfo(const char * name, const char * service, const addrinfo * hints, addrinfo ** found)
{
  static const auto look_up = reinterpret_cast<decltype(&getaddrinfo)>(dlsym(RTLD_NEXT, "getaddrinfo"));
  if (name == nullptr || !std::string_view(name).ends_with(domain)) {
    return look_up(name, service, hints, found);
  }
  return name_server_answers ? look_up(ur_ros_rtde::test::own_address().c_str(), service, hints, found)
                             : EAI_AGAIN;
}

namespace ur_ros_rtde::test {
namespace {

TEST(StopProgramTest, DoesNotWaitForANameServer)
{
  Controller controller(Controller::options());
  ASSERT_TRUE(TcpSocket::connect("robot.test", dashboard_port, 1s));  // as when the driver starts
  name_server_answers = false;
  const auto stopped = stop_program("robot.test", 1s);
  EXPECT_TRUE(stopped) << stopped.error().message;
}

TEST(TcpSocketTest, RepeatsAFailedNameLookup)
{
  Controller controller(Controller::options());
  name_server_answers = false;
  const auto not_found = TcpSocket::connect("other.test", dashboard_port, 1s);
  ASSERT_FALSE(not_found);
  EXPECT_NE(not_found.error().message.find("`other.test` cannot be resolved"), std::string::npos);
  name_server_answers = true;
  EXPECT_TRUE(TcpSocket::connect("other.test", dashboard_port, 1s));
}

}  // namespace
}  // namespace ur_ros_rtde::test
