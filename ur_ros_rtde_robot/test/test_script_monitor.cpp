#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <string>
#include <thread>
#include <tuple>
#include <utility>

#include "primary_messages.hpp"
#include "program/execution/script_monitor.hpp"
#include "state_receiver_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

/// The simulator has the ports of own_address(), whose last number is never 1.
std::string other_address()
{
  const auto own = own_address();
  return own.substr(0, own.rfind('.')) + ".1";
}

/// A primary interface with one client, which sends `answer` when it has received a script.
class PrimaryServer {
 public:
  explicit PrimaryServer(std::string answer)
      : answer_(std::move(answer)), listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0))
  {
    const int on = 1;
    ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(30001);
    ::inet_pton(AF_INET, other_address().c_str(), &address.sin_addr);
    if (::bind(listener_, reinterpret_cast<const sockaddr *>(&address), sizeof(address)) != 0 ||
        ::listen(listener_, 1) != 0) {
      ADD_FAILURE() << "cannot listen on " << other_address();
    }
    thread_ = std::jthread([this] { serve(); });
  }
  ~PrimaryServer()
  {
    ::shutdown(listener_, SHUT_RDWR);
    thread_.join();
    ::close(listener_);
  }
  PrimaryServer(const PrimaryServer &) = delete;
  PrimaryServer & operator=(const PrimaryServer &) = delete;

 private:
  void serve() const
  {
    const int client = ::accept(listener_, nullptr, nullptr);
    send(client, primary::text("hello"));
    std::array<char, 4096> script;
    if (::recv(client, script.data(), script.size(), 0) > 0) {
      send(client, answer_);
    }
    while (::recv(client, script.data(), script.size(), 0) > 0) {
    }
    ::close(client);
  }
  static void send(int client, const std::string & bytes)
  {
    std::ignore = ::send(client, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }

  const std::string answer_;
  const int listener_;
  std::jthread thread_;
};

using ScriptMonitorTest = StateReceiverTest;

TEST_F(ScriptMonitorTest, EndsAtOnceIfTheScriptIsStoppedBeforeItsFirstLine)
{
  controller.start();
  const auto state = receiver();
  ASSERT_TRUE(connected(*state));
  const ScriptMonitor::Markers markers{"begins", "ends"};
  const auto program = script::make_program("sync()", {false, markers.begin, markers.end, ""});
  ASSERT_TRUE(program);
  const PrimaryServer server(primary::key("PROGRAM_XXX_STARTED", program->name) +
                             primary::key("PROGRAM_XXX_STOPPED", program->name));
  auto connection = PrimaryConnection::connect(other_address(), 5s);
  ASSERT_TRUE(connection) << connection.error().message;
  const ScriptOptions options;
  ScriptMonitor monitor(*std::move(connection), *state, markers, options);
  monitor.run(*program);
  EXPECT_EQ(monitor.report().end, ScriptEnd::stopped) << monitor.report().error.message;
  EXPECT_FALSE(monitor.may_be_running());
  EXPECT_LT(monitor.report().duration, 2.5) << "not by the limit for the begin";
}

}  // namespace
}  // namespace ur_ros_rtde::test
