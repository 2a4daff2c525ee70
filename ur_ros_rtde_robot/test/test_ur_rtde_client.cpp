// Clients of ur_rtde against servers that do not behave like a controller.
#include <gtest/gtest.h>
#include <ur_rtde/rtde.h>
#include <ur_rtde/script_client.h>

#include <boost/system/system_error.hpp>
#include <chrono>

#include "reply_server.hpp"

namespace ur_ros_rtde::test {
namespace {

using Clock = std::chrono::steady_clock;

/// An RTDE package.
std::string package(char type, const std::string & body)
{
  const auto size = static_cast<unsigned>(body.size() + 3);
  return std::string{static_cast<char>(size >> 8U), static_cast<char>(size & 0xffU), type} + body;
}

TEST(RtdeReplyTest, IsNotATextMessage)
{
  const std::string text = package('M', std::string("\x04"
                                                    "text"
                                                    "\x01"
                                                    "a"
                                                    "\x02",
                                                    8));
  const std::string version(
      "\0\0\0\5"
      "\0\0\0\x19"
      "\0\0\0\1"
      "\0\0\0\0",
      16);
  ur_fuzz::ReplyServer server(ur_fuzz::test_address(), 0);
  server.set_reply({}, text + package('V', "\x01") + text + text + package('v', version));
  ur_rtde::RTDE rtde(ur_fuzz::test_address(), server.port());
  rtde.connect();
  EXPECT_TRUE(rtde.negotiateProtocolVersion());
  EXPECT_EQ(rtde.getControllerVersion(), std::make_tuple(5U, 25U, 1U, 0U));
}

/// Completes connections, and reads nothing.
class DeafServer {
 public:
  DeafServer() : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0))
  {
    const int buffer = 4096;
    ::setsockopt(listener_, SOL_SOCKET, SO_RCVBUF, &buffer, sizeof(buffer));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    ::inet_pton(AF_INET, ur_fuzz::test_address().c_str(), &address.sin_addr);
    socklen_t size = sizeof(address);
    if (::bind(listener_, reinterpret_cast<sockaddr *>(&address), size) != 0 || ::listen(listener_, 1) != 0 ||
        ::getsockname(listener_, reinterpret_cast<sockaddr *>(&address), &size) != 0) {
      throw std::system_error(errno, std::generic_category(), "port of the server");
    }
    port_ = ntohs(address.sin_port);
  }
  ~DeafServer() { ::close(listener_); }
  DeafServer(const DeafServer &) = delete;
  DeafServer & operator=(const DeafServer &) = delete;

  std::uint16_t port() const { return port_; }

 private:
  int listener_;
  std::uint16_t port_ = 0;
};

TEST(ScriptClientTest, DoesNotWaitForAControllerThatReadsNothing)
{
  const DeafServer server;
  ur_rtde::ScriptClient client(ur_fuzz::test_address(), 5, 25, server.port());
  client.connect();
  client.setScript(std::string(20'000'000, '#'));
  const auto begin = Clock::now();
  EXPECT_THROW(client.sendScript(), boost::system::system_error);
  EXPECT_LT(Clock::now() - begin, std::chrono::seconds(20));
}

}  // namespace
}  // namespace ur_ros_rtde::test
