#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <thread>
#include <vector>

#include "robotiq/robotiq_client.hpp"

namespace ur_ros_rtde_gripper_commands {
namespace {

using ur_ros_rtde::ErrorCode;

/// Answers the requests of one client, one after the other, each with pieces that are sent one by one. Closes
/// the connection afterwards.
class Server {
 public:
  explicit Server(std::vector<std::vector<std::string>> answers) : answers_(std::move(answers))
  {
    listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    EXPECT_EQ(::bind(listener_, reinterpret_cast<sockaddr *>(&address), size), 0);
    EXPECT_EQ(::listen(listener_, 1), 0);
    ::getsockname(listener_, reinterpret_cast<sockaddr *>(&address), &size);
    port = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~Server()
  {
    join();
    ::close(listener_);
  }
  /// Waits until the client has closed the connection.
  void join()
  {
    if (thread_.joinable()) {
      thread_.join();
    }
  }

  std::uint16_t port = 0;
  std::vector<std::string> requests;  ///< complete after join()

 private:
  void serve()
  {
    const int client = ::accept(listener_, nullptr, nullptr);
    for (const auto & pieces : answers_) {
      std::string line;
      for (char c = 0; c != '\n' && ::recv(client, &c, 1, 0) == 1;) {
        line.push_back(c);
      }
      requests.push_back(line);
      for (const std::string & piece : pieces) {
        ::send(client, piece.data(), piece.size(), MSG_NOSIGNAL);
      }
    }
    ::shutdown(client, SHUT_WR);
    char rest = 0;
    while (::recv(client, &rest, 1, 0) > 0) {
    }
    ::close(client);
  }

  std::vector<std::vector<std::string>> answers_;
  int listener_ = -1;
  std::thread thread_;
};

RobotiqClient connect_to(const Server & server)
{
  auto client = RobotiqClient::connect("127.0.0.1", server.port);
  EXPECT_TRUE(client) << client.error().message;
  return std::move(*client);
}

TEST(RobotiqClientTest, ReadsRegistersWithAndWithoutALineEnd)
{
  Server server({{"POS 12\n"}, {"POS 013\r\n"}, {"POS ", "1", "4\n"}, {"POS 15"}});
  RobotiqClient client = connect_to(server);
  for (const int expected : {12, 13, 14, 15}) {
    const auto value = client.get("POS");
    ASSERT_TRUE(value) << value.error().message;
    EXPECT_EQ(*value, expected);
  }
}

TEST(RobotiqClientTest, WritesRegistersAndWaitsForTheAcknowledgement)
{
  Server server({{"ack"}, {"a", "ck"}, {"ack\n"}, {"?"}});
  {
    RobotiqClient client = connect_to(server);
    EXPECT_TRUE(client.set("POS 255 GTO 1"));
    EXPECT_TRUE(client.set("GTO 0"));
    EXPECT_TRUE(client.set("ACT 1"));
    const auto rejected = client.set("XYZ 1");
    ASSERT_FALSE(rejected);
    EXPECT_EQ(rejected.error().code, ErrorCode::rejected_by_robot);
    EXPECT_NE(rejected.error().message.find("`?` to `SET XYZ 1`"), std::string::npos);
  }
  server.join();
  EXPECT_EQ(server.requests,
            (std::vector<std::string>{"SET POS 255 GTO 1\n", "SET GTO 0\n", "SET ACT 1\n", "SET XYZ 1\n"}));
}

TEST(RobotiqClientTest, TakesNeitherTheAnswerToAnotherRequestNorAnImpossibleValue)
{
  Server server({{"OBJ 3\n"}, {"16\n"}, {"POS 256\n"}, {"POS -1\n"}});
  RobotiqClient client = connect_to(server);
  for (int i = 0; i < 4; ++i) {
    const auto value = client.get("POS");
    ASSERT_FALSE(value) << *value;
    EXPECT_EQ(value.error().code, ErrorCode::rejected_by_robot);
  }
}

TEST(RobotiqClientTest, ReportsAGripperThatTheUrcapCannotRead)
{
  Server server({{"STA ?\n"}, {"?"}, {"hello"}});
  RobotiqClient client = connect_to(server);
  for (int i = 0; i < 2; ++i) {
    const auto value = client.get("STA");
    ASSERT_FALSE(value);
    EXPECT_EQ(value.error().code, ErrorCode::not_ready);
  }
  const auto value = client.get("STA");
  ASSERT_FALSE(value);
  EXPECT_EQ(value.error().code, ErrorCode::rejected_by_robot);
  EXPECT_NE(value.error().message.find("`hello` to `GET STA`"), std::string::npos);
}

TEST(RobotiqClientTest, ReportsAConnectionThatTheServerCloses)
{
  Server server({{"ack"}});
  RobotiqClient client = connect_to(server);
  ASSERT_TRUE(client.set("ACT 1"));
  const auto value = client.get("STA");
  ASSERT_FALSE(value);
  EXPECT_EQ(value.error().code, ErrorCode::link_lost);
}

TEST(RobotiqClientTest, ReportsAMissingUrcap)
{
  std::uint16_t port = 0;
  {
    Server server({});
    port = server.port;
    connect_to(server);
  }
  const auto client = RobotiqClient::connect("127.0.0.1", port);
  ASSERT_FALSE(client);
  EXPECT_EQ(client.error().code, ErrorCode::not_supported);
  EXPECT_NE(client.error().message.find("install Robotiq's URCap"), std::string::npos);
}

}  // namespace
}  // namespace ur_ros_rtde_gripper_commands
