#include <map>

#include "support/raw_socket.hpp"
#include "support/rtde_client.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

/// Reads the messages of ports 30001 and 30002.
class MessageReader {
 public:
  MessageReader(const std::string & address, std::uint16_t port) : socket_(address, port) {}

  /// The next message of that type (16 robot state, 20 robot message), from its type byte on.
  std::string next(char type)
  {
    for (;;) {
      std::string message = socket_.receive(number(socket_.receive(4)) - 4);
      if (message[0] == type) {
        return message;
      }
    }
  }
  /// The next robot message of that kind (0 text, 7 key, 10 runtime exception, …).
  std::string next_robot_message(char kind)
  {
    for (;;) {
      std::string message = next(20);
      if (message[10] == kind) {
        return message;
      }
    }
  }
  /// Sub-packages of the next robot state by their type, without size and type.
  std::map<int, std::string> next_state()
  {
    const std::string message = next(16);
    std::map<int, std::string> packages;
    for (std::size_t at = 1; at < message.size();) {
      const std::size_t size = number(message.substr(at, 4));
      packages[message[at + 4]] = message.substr(at + 5, size - 5);
      at += size;
    }
    return packages;
  }
  RawSocket & socket() { return socket_; }

 private:
  RawSocket socket_;
};

using PrimaryInterface = SimulatorTest;

TEST_F(PrimaryInterface, sends_the_robots_state_ten_times_a_second)
{
  for (const std::uint16_t port : {30001, 30002}) {
    MessageReader reader(controller.address(), port);
    const std::uint64_t first = number(reader.next_state().at(0).substr(0, 8));
    const std::uint64_t second = number(reader.next_state().at(0).substr(0, 8));
    EXPECT_EQ(second - first, 100000u);  // microseconds
  }
}

TEST_F(PrimaryInterface, lays_out_its_packages_as_the_client_interface_says)
{
  MessageReader reader(controller.address(), 30001);
  const auto packages = reader.next_state();
  const std::map<int, std::size_t> sizes{{0, 42},  {1, 246}, {2, 32}, {3, 70}, {4, 96},
                                         {5, 220}, {6, 440}, {7, 56}, {8, 4}};
  for (const auto & [type, size] : sizes) {
    ASSERT_TRUE(packages.contains(type)) << type;
    EXPECT_EQ(packages.at(type).size(), size) << type;
  }
  const json state = controller.state();
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(real(packages.at(1).substr(41 * i, 8)), state["actual"]["position"][i].get<double>(), 1e-6);
    EXPECT_NEAR(real(packages.at(4).substr(8 * i, 8)), state["actual_tcp_pose"][i].get<double>(), 1e-6);
  }
  EXPECT_EQ(packages.at(0)[15], 7);                      // robot mode RUNNING
  EXPECT_EQ(packages.at(3)[60], 1);                      // safety mode NORMAL
  EXPECT_EQ(number(packages.at(6).substr(432, 4)), 2u);  // a UR10
}

TEST_F(PrimaryInterface, tells_the_line_of_a_compile_error)
{
  MessageReader reader(controller.address(), 30001);
  reader.socket().send("def bad():\n  sync()\n  no_such_function()\nend\n");
  const std::string message = reader.next_robot_message(10);
  EXPECT_EQ(number(message.substr(11, 4)), 3u);
  EXPECT_GT(number(message.substr(15, 4)), 0u);
  EXPECT_NE(message.find("no_such_function"), std::string::npos);
}

TEST_F(PrimaryInterface, tells_the_line_of_a_run_time_error)
{
  MessageReader reader(controller.address(), 30001);
  reader.socket().send("def fails():\n  sync()\n  a = [1, 2]\n  b = a[7]\nend\n");
  const std::string message = reader.next_robot_message(10);
  EXPECT_EQ(number(message.substr(11, 4)), 4u);
}

TEST_F(PrimaryInterface, tells_when_a_program_starts_and_ends)
{
  MessageReader reader(controller.address(), 30001);
  reader.socket().send("def short_one():\n  sync()\nend\n");
  EXPECT_NE(reader.next_robot_message(7).find("PROGRAM_XXX_STARTEDshort_one"), std::string::npos);
  EXPECT_NE(reader.next_robot_message(7).find("PROGRAM_XXX_STOPPEDshort_one"), std::string::npos);
}

TEST_F(PrimaryInterface, shows_popups)
{
  MessageReader reader(controller.address(), 30001);
  reader.socket().send(
      "def ask():\n  popup(\"mind the gap\", \"Attention\", True, False, blocking=False)\nend\n");
  const std::string message = reader.next_robot_message(2);
  EXPECT_EQ(message[16], 1);  // a warning
  EXPECT_EQ(message[17], 0);
  EXPECT_NE(message.find("Attentionmind the gap"), std::string::npos);
}

TEST_F(PrimaryInterface, reports_a_protective_stop)
{
  MessageReader reader(controller.address(), 30001);
  reader.next(16);
  controller.control({{"command", "protective_stop"}, {"reason", "for a test"}});
  const std::string message = reader.next_robot_message(6);
  EXPECT_EQ(number(message.substr(19, 4)), 3u);
  EXPECT_NE(message.find("for a test"), std::string::npos);
}

}  // namespace
}  // namespace ur_simulator::testing
