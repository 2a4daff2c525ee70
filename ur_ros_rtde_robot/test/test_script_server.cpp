#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <atomic>

#include "program/script_server.hpp"
#include "support.hpp"
#include "ur_ros_rtde_robot/connection/tcp_socket.hpp"

namespace ur_ros_rtde::test {
namespace {

using Clock = std::chrono::steady_clock;

struct ScriptServerTest : testing::Test {
  const std::uint16_t port = free_port();
  Log log;
  std::atomic<bool> known{true};
  ScriptServer server{
      port,
      50ms,
      {[this] { return known ? std::optional(ControllerVersion{5, 11, 0, 0}) : std::nullopt; },
       [](const ControllerVersion & version) {
         return std::string(1'000'000, 'x') + std::to_string(version.minor) + "\n";
       }},
      log.function()};

  void SetUp() override
  {
    server.start();
    ASSERT_TRUE(eventually([&] { return server.status().has_value(); }));
  }

  TcpSocket connect() { return std::move(TcpSocket::connect(own_address(), port, 1s).value()); }
};

TEST_F(ScriptServerTest, SendsTheWholeProgramToEachClient)
{
  TcpSocket silent = connect();
  for (int i = 0; i < 2; ++i) {
    TcpSocket client = connect();
    ASSERT_TRUE(client.write("request_", Clock::now() + 1s));
    ASSERT_TRUE(client.write("program\n", Clock::now() + 1s));
    std::vector<std::byte> program(1'000'003);
    ASSERT_TRUE(client.read(program, Clock::now() + 5s));
    EXPECT_EQ(std::to_integer<char>(program[1'000'001]), '1');
  }
  EXPECT_EQ(server.fetched(), 2U);
}

TEST_F(ScriptServerTest, ClosesTheConnectionAfterAnUnknownRequest)
{
  for (const std::string request : {"GET / HTTP/1.1\r\n", "request_program_or_whatever\n"}) {
    TcpSocket client = connect();
    ASSERT_TRUE(client.write(request + std::string(200, 'x'), Clock::now() + 1s));
    std::byte answer{};
    const auto status = client.read(std::span(&answer, 1), Clock::now() + 5s);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().message.find("does not answer"), std::string::npos) << status.error().message;
  }
  EXPECT_EQ(server.fetched(), 0U);
}

/// While it exists, this process cannot open files.
class NoDescriptors {
 public:
  NoDescriptors()
  {
    ::getrlimit(RLIMIT_NOFILE, &limit_);
    while (true) {
      const int descriptor = ::dup(STDIN_FILENO);
      if (descriptor < 0 || opened_.size() == 4096) {
        break;
      }
      opened_.push_back(descriptor);
      rlimit lowered = limit_;
      lowered.rlim_cur = static_cast<rlim_t>(descriptor) + 1;
      ::setrlimit(RLIMIT_NOFILE, &lowered);
    }
  }
  ~NoDescriptors()
  {
    ::setrlimit(RLIMIT_NOFILE, &limit_);
    for (const int descriptor : opened_) {
      ::close(descriptor);
    }
  }
  NoDescriptors(const NoDescriptors &) = delete;
  NoDescriptors & operator=(const NoDescriptors &) = delete;

 private:
  rlimit limit_{};
  std::vector<int> opened_;
};

double processor_time()
{
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

TEST_F(ScriptServerTest, WaitsWhenItCannotAcceptAConnection)
{
  const int client = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  ::inet_pton(AF_INET, own_address().c_str(), &address.sin_addr);
  {
    const NoDescriptors none;
    ASSERT_EQ(::connect(client, reinterpret_cast<const sockaddr *>(&address), sizeof(address)), 0);
    const double begin = processor_time();
    std::this_thread::sleep_for(500ms);
    EXPECT_LT(processor_time() - begin, 0.1);
  }
  const std::string request = "request_program\n";
  ASSERT_EQ(::send(client, request.data(), request.size(), 0), static_cast<ssize_t>(request.size()));
  EXPECT_TRUE(eventually([&] { return server.fetched() == 1U; }));
  EXPECT_EQ(log.count("cannot serve the control program"), 1U) << log.text();
  ::close(client);
}

TEST_F(ScriptServerTest, SendsNothingWhileTheControllerIsUnknown)
{
  known = false;
  TcpSocket client = connect();
  ASSERT_TRUE(client.write("request_program\n", Clock::now() + 1s));
  std::byte answer{};
  EXPECT_FALSE(client.read(std::span(&answer, 1), Clock::now() + 5s));
  EXPECT_TRUE(eventually([&] { return log.count("press play again") == 1U; })) << log.text();
  EXPECT_EQ(server.fetched(), 0U);
}

}  // namespace
}  // namespace ur_ros_rtde::test
