#include <map>

#include "support/primary_client.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

using PrimaryInterfaceTest = SimulatorTest;

TEST_F(PrimaryInterfaceTest, SendsRobotStateAtTenHertz)
{
  for (const std::uint16_t port : {30001, 30002}) {
    PrimaryClient client(controller.address(), port);
    const std::uint64_t first = decode_uint(client.receive_robot_state().at(0).substr(0, 8));
    const std::uint64_t second = decode_uint(client.receive_robot_state().at(0).substr(0, 8));
    EXPECT_EQ(second - first, 100000u);  // microseconds
  }
}

TEST_F(PrimaryInterfaceTest, EncodesPackagesAsInClientInterfaceManual)
{
  PrimaryClient client(controller.address(), 30001);
  const auto packages = client.receive_robot_state();
  const std::map<int, std::size_t> sizes{{0, 42},  {1, 246}, {2, 32}, {3, 70}, {4, 96},
                                         {5, 220}, {6, 440}, {7, 56}, {8, 4}};
  for (const auto & [type, size] : sizes) {
    ASSERT_TRUE(packages.contains(type)) << type;
    EXPECT_EQ(packages.at(type).size(), size) << type;
  }
  const json state = controller.state();
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(decode_double(packages.at(1).substr(41 * i, 8)), state["actual"]["position"][i].get<double>(),
                1e-6);
    EXPECT_NEAR(decode_double(packages.at(4).substr(8 * i, 8)), state["actual_tcp_pose"][i].get<double>(),
                1e-6);
  }
  EXPECT_EQ(packages.at(0)[15], 7);                           // robot mode RUNNING
  EXPECT_EQ(packages.at(3)[60], 1);                           // safety mode NORMAL
  EXPECT_EQ(decode_uint(packages.at(6).substr(432, 4)), 2u);  // a UR10
}

TEST_F(PrimaryInterfaceTest, ReportsLineOfCompileError)
{
  PrimaryClient client(controller.address(), 30001);
  client.socket().send("def bad():\n  sync()\n  no_such_function()\nend\n");
  const std::string message = client.receive_robot_message(10);
  EXPECT_EQ(decode_uint(message.substr(11, 4)), 3u);
  EXPECT_GT(decode_uint(message.substr(15, 4)), 0u);
  EXPECT_NE(message.find("no_such_function"), std::string::npos);
}

TEST_F(PrimaryInterfaceTest, ReportsLineOfRunTimeError)
{
  PrimaryClient client(controller.address(), 30001);
  client.socket().send("def fails():\n  sync()\n  a = [1, 2]\n  b = a[7]\nend\n");
  const std::string message = client.receive_robot_message(10);
  EXPECT_EQ(decode_uint(message.substr(11, 4)), 4u);
}

TEST_F(PrimaryInterfaceTest, ReportsStartAndEndOfProgram)
{
  PrimaryClient client(controller.address(), 30001);
  client.socket().send("def short_one():\n  sync()\nend\n");
  EXPECT_NE(client.receive_robot_message(7).find("PROGRAM_XXX_STARTEDshort_one"), std::string::npos);
  EXPECT_NE(client.receive_robot_message(7).find("PROGRAM_XXX_STOPPEDshort_one"), std::string::npos);
}

TEST_F(PrimaryInterfaceTest, ReportsPopups)
{
  PrimaryClient client(controller.address(), 30001);
  client.socket().send(
      "def ask():\n  popup(\"mind the gap\", \"Attention\", True, False, blocking=False)\nend\n");
  const std::string message = client.receive_robot_message(2);
  EXPECT_EQ(message[16], 1);  // a warning
  EXPECT_EQ(message[17], 0);
  EXPECT_NE(message.find("Attentionmind the gap"), std::string::npos);
}

TEST_F(PrimaryInterfaceTest, ReportsProtectiveStop)
{
  PrimaryClient client(controller.address(), 30001);
  client.receive_message(16);
  controller.control({{"command", "protective_stop"}, {"reason", "for a test"}});
  const std::string message = client.receive_robot_message(6);
  EXPECT_EQ(decode_uint(message.substr(19, 4)), 3u);
  EXPECT_NE(message.find("for a test"), std::string::npos);
}

}  // namespace
}  // namespace ur_simulator::testing
