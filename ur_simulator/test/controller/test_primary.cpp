#include "kinematics/robot_model.hpp"
#include "primary/messages.hpp"
#include "primary/realtime_packet.hpp"
#include "primary/robot_state.hpp"
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
  const std::map<int, std::size_t> sizes{{0, 42},  {1, 246}, {2, 32}, {3, 70},  {4, 96}, {5, 220},
                                         {6, 440}, {7, 56},  {8, 4},  {11, 21}, {12, 3}};
  for (const auto & [type, size] : sizes) {
    ASSERT_TRUE(packages.contains(type)) << type;
    EXPECT_EQ(packages.at(type).size(), size) << type;
  }
  const json state = controller.state();
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(decode_double(packages.at(1).substr(41 * i, 8)), state["actual"]["position"][i].get<double>(),
                reading_noise);
    EXPECT_NEAR(decode_double(packages.at(4).substr(8 * i, 8)), state["actual_tcp_pose"][i].get<double>(),
                reading_noise);
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

/// Code, argument, report level and text of an error code message.
struct ReceivedErrorCode {
  std::uint64_t code, argument, level;
  std::string text;
};

ReceivedErrorCode receive_error_code(PrimaryClient & client)
{
  const std::string message = client.receive_robot_message(6);
  return {decode_uint(message.substr(11, 4)), decode_uint(message.substr(15, 4)),
          decode_uint(message.substr(19, 4)), message.substr(31)};
}

std::uint8_t receive_safety_mode(PrimaryClient & client)
{
  return static_cast<std::uint8_t>(client.receive_robot_message(5)[19]);
}

TEST_F(PrimaryInterfaceTest, ReportsProtectiveStopAsWarning)
{
  PrimaryClient client(controller.address(), 30001);
  client.receive_message(16);
  controller.control({{"command", "protective_stop"}, {"reason", "for a test"}});
  EXPECT_EQ(receive_safety_mode(client), 3);
  const ReceivedErrorCode error = receive_error_code(client);
  EXPECT_EQ(error.level, 2u);
  EXPECT_EQ(error.text, "protective stop: for a test");
}

TEST_F(PrimaryInterfaceTest, ReportsCollisionWithItsCode)
{
  PrimaryClient client(controller.address(), 30001);
  client.receive_message(16);
  controller.control({{"command", "push"}, {"force", {0, 900, 0}}, {"duration", 0.5}});
  const ReceivedErrorCode error = receive_error_code(client);
  EXPECT_EQ(error.code, 158u);  // the payload is 0 kg
  EXPECT_EQ(error.argument, 0u) << "the base joint has the longest lever";
  EXPECT_EQ(error.level, 2u);
}

TEST_F(PrimaryInterfaceTest, ReportsCollisionWithPayload)
{
  controller.control({{"command", "run_script"}, {"script", "sec load():\n  set_payload(1.0)\nend\n"}});
  ASSERT_TRUE(wait_simulated_time(controller, 0.1, seconds(5)));
  PrimaryClient client(controller.address(), 30001);
  client.receive_message(16);
  controller.control({{"command", "push"}, {"force", {0, 900, 0}}, {"duration", 0.5}});
  EXPECT_EQ(receive_error_code(client).code, 157u);
}

TEST_F(PrimaryInterfaceTest, ReportsSafetyModesAndLevelsOfFailures)
{
  PrimaryClient client(controller.address(), 30001);
  client.receive_message(16);
  controller.control({{"command", "emergency_stop"}});
  EXPECT_EQ(receive_safety_mode(client), 7);
  controller.control({{"command", "emergency_stop"}, {"pressed", false}});
  EXPECT_EQ(receive_safety_mode(client), 1);
  controller.control({{"command", "violation"}});
  EXPECT_EQ(receive_safety_mode(client), 8);
  EXPECT_EQ(receive_error_code(client).level, 3u);
  controller.control({{"command", "fault"}});
  EXPECT_EQ(receive_safety_mode(client), 9);
  EXPECT_EQ(receive_error_code(client).level, 4u);
}

TEST_F(PrimaryInterfaceTest, UnreachableTargetIsAProtectiveStopWithItsCode)
{
  PrimaryClient client(controller.address(), 30001);
  client.socket().send(
      "def far():\n  movel(p[10, 0, 0, 0, 0, 0])\n  set_standard_digital_out(0, True)\nend\n");
  const ReceivedErrorCode error = receive_error_code(client);
  EXPECT_EQ(error.code, 204u);
  EXPECT_EQ(error.argument, 5u);
  EXPECT_EQ(error.level, 2u);
  EXPECT_TRUE(wait_for_program_state(controller, "PAUSED"));
  EXPECT_EQ(controller.state()["safety_mode"], "PROTECTIVE_STOP");
  EXPECT_EQ(controller.state()["io"]["digital_outputs"], 0);
}

// A client that waits for the safety mode in one of the two must not find another one in the other.
TEST_F(PrimaryInterfaceTest, RobotStateIsNotOlderThanTheSafetyModeMessage)
{
  constexpr std::size_t protective_stopped = 12;  // after the timestamp and four flags
  PrimaryClient client(controller.address(), 30001);
  EXPECT_EQ(client.receive_robot_state().at(0)[protective_stopped], 0);
  client.socket().send("def stop_it():\n  protective_stop()\nend\n");
  char stopped = 0;
  for (;;) {
    const std::string message = client.receive_message();
    if (message[0] == 16) {
      stopped = robot_state_packages(message).at(0)[protective_stopped];
    } else if (message[0] == 20 && message[10] == 5) {
      break;
    }
  }
  EXPECT_EQ(stopped, 1);
}

TEST_F(PrimaryInterfaceTest, ProgramEndsAfterItsLastStatementIsAProtectiveStop)
{
  PrimaryClient client(controller.address(), 30001);
  client.socket().send("def stop_it():\n  protective_stop()\nend\n");
  EXPECT_NE(client.receive_robot_message(7).find("PROGRAM_XXX_STARTEDstop_it"), std::string::npos);
  EXPECT_NE(client.receive_robot_message(7).find("PROGRAM_XXX_STOPPEDstop_it"), std::string::npos);
  EXPECT_EQ(receive_safety_mode(client), 3);
}

TEST_F(PrimaryInterfaceTest, ProgramPausesAfterAProtectiveStopWhereItWaits)
{
  PrimaryClient client(controller.address(), 30001);
  client.socket().send(
      "def stop_it():\n  protective_stop()\n  sync()\n  set_standard_digital_out(0, True)\nend\n");
  EXPECT_EQ(receive_safety_mode(client), 3);
  EXPECT_TRUE(wait_for_program_state(controller, "PAUSED"));
  EXPECT_EQ(controller.state()["io"]["digital_outputs"], 0);
}

TEST_F(PrimaryInterfaceTest, NamesUndefinedFunctionAsRobotDoes)
{
  PrimaryClient client(controller.address(), 30001);
  client.socket().send("def bad():\n  no_such_function()\nend\n");
  const std::string message = client.receive_robot_message(10);
  EXPECT_EQ(decode_uint(message.substr(11, 4)), 2u);
  EXPECT_EQ(decode_uint(message.substr(15, 4)), 3u);
  EXPECT_EQ(message.substr(19), "compile_error_name_not_found:no_such_function:");
}

// Recorded: the text of a client's program whose second line lacks a parenthesis.
TEST_F(PrimaryInterfaceTest, QuotesTheLineOfASyntaxErrorAsRobotDoes)
{
  PrimaryClient client(controller.address(), 30001);
  client.socket().send("def bad():\n  textmsg(\"log \", get_actual_tcp_pose()\nend\n");
  const std::string message = client.receive_robot_message(10);
  EXPECT_EQ(decode_uint(message.substr(11, 4)), 3u);
  EXPECT_EQ(message.substr(19), "syntax_error_on_line:3:end:");
  client.socket().send("def bad():\n  while True\n    sync()\n  end\nend\n");
  EXPECT_EQ(client.receive_robot_message(10).substr(19), "syntax_error_on_line:3:    sync():");
}

TEST_F(PrimaryInterfaceTest, NamesTheErrorOfASecondaryProgramAsRobotDoes)
{
  PrimaryClient client(controller.address(), 30001);
  client.socket().send("sec bad():\n  a = [1, 2]\n  b = a[7]\nend\n");
  EXPECT_EQ(client.receive_robot_message(10).substr(19),
            "SECONDARY_PROGRAM_EXCEPTION_XXXindex 7 is out of range: the list has 2 elements");
}

TEST_F(PrimaryInterfaceTest, AFailedProgramIsReportedAsStopped)
{
  PrimaryClient client(controller.address(), 30001);
  client.socket().send("def fails():\n  sync()\n  a = [1, 2]\n  b = a[7]\nend\n");
  EXPECT_NE(client.receive_robot_message(10).find("failed in line 4"), std::string::npos);
  EXPECT_NE(client.receive_robot_message(7).find("PROGRAM_XXX_STOPPEDfails"), std::string::npos);
}

TEST_F(PrimaryInterfaceTest, SecondaryProgramTriggersProtectiveStop)
{
  PrimaryClient client(controller.address(), 30001);
  client.socket().send("sec stop_it():\n  protective_stop()\nend\n");
  EXPECT_EQ(receive_safety_mode(client), 3);
  const ReceivedErrorCode error = receive_error_code(client);
  EXPECT_EQ(error.code, 209u);
  EXPECT_NE(error.text.find("protective_stop()"), std::string::npos);
}

TEST_F(PrimaryInterfaceTest, LocalControlMakesItReadOnly)
{
  controller.control({{"command", "remote_control"}, {"on", false}});
  PrimaryClient client(controller.address(), 30001);
  client.socket().send("def mine():\n  sync()\nend\n");
  EXPECT_EQ(receive_error_code(client).code, 210u);
}

TEST_F(PrimaryInterfaceTest, ReadOnlyPortsSendTheSameDataAndRejectScripts)
{
  PrimaryClient primary(controller.address(), 30011);
  EXPECT_EQ(primary.receive_robot_state().size(), 11u);
  PrimaryClient secondary(controller.address(), 30012);
  EXPECT_EQ(secondary.receive_robot_state().size(), 11u);
  TcpClient realtime(controller.address(), 30013);
  EXPECT_EQ(decode_uint(realtime.receive(4)), 1220u);
  for (TcpClient * client : {&primary.socket(), &secondary.socket(), &realtime}) {
    client->send("def mine():\n  set_standard_digital_out(0, True)\nend\n");
    EXPECT_EQ(receive_error_code(primary).code, 210u);
  }
  EXPECT_EQ(controller.state()["io"]["digital_outputs"], 0);
}

/// Sizes of the sub-packages of a robot state message by type, without size and type.
std::map<int, std::string> packages_of(const RobotModel & model, const char * version)
{
  const std::string message =
      primary::robot_state_message(model, *PolyscopeVersion::parse(version), ControllerState());
  std::map<int, std::string> packages;
  for (std::size_t begin = 5; begin < message.size();) {
    const std::size_t size = decode_uint(message.substr(begin, 4));
    packages[message[begin + 4]] = message.substr(begin + 5, size - 5);
    begin += size;
  }
  return packages;
}

TEST(RobotStateVersionTest, LengthsAreThoseOfTheVersion)
{
  // Lengths of the parsers of ur_modern_driver.
  const auto expect_lengths = [](const char * version, std::size_t robot_mode, std::size_t masterboard) {
    const auto packages = packages_of(find_robot_model("ur10")->get(), version);
    EXPECT_EQ(packages.at(0).size(), robot_mode) << version;
    EXPECT_EQ(packages.at(3).size(), masterboard) << version;
    EXPECT_FALSE(packages.contains(11));
  };
  expect_lengths("3.1", 33, 67);
  expect_lengths("3.4", 41, 69);
  expect_lengths("3.5", 42, 69);
  expect_lengths("3.15", 42, 70);
  const auto e_series = packages_of(find_robot_model("ur10e")->get(), "5.25");
  EXPECT_EQ(e_series.at(0).size(), 42u);
  EXPECT_EQ(e_series.at(11).size(), 21u);
  EXPECT_EQ(e_series.at(12).size(), 3u);
}

// The messages in the tests of the Universal Robots Client Library: -2 robot interface, -3 runtime machine.
TEST(RobotMessageTest, NamesItsSource)
{
  constexpr std::size_t source = 13;
  EXPECT_EQ(primary::version_message(*PolyscopeVersion::parse("5.25"))[source], char(-2));
  EXPECT_EQ(primary::key_message(1.0, "PROGRAM_XXX_STARTED", "mine")[source], char(-2));
  EXPECT_EQ(primary::runtime_exception_message(1.0, 3, 1, "compile_error")[source], char(-3));
  EXPECT_EQ(primary::safety_mode_message(1.0, 3)[source], char(-3));
}

TEST(RealtimePacketTest, SizeIsThatOfTheVersion)
{
  const auto size = [](const char * version) {
    primary::RealtimePacket packet(*PolyscopeVersion::parse(version));
    const std::string bytes(packet.encode(ControllerState()));
    EXPECT_EQ(decode_uint(bytes.substr(0, 4)), bytes.size()) << version;
    return bytes.size();
  };
  EXPECT_EQ(size("3.4"), 1060u);
  EXPECT_EQ(size("3.5"), 1108u);
  EXPECT_EQ(size("3.9"), 1108u);
  EXPECT_EQ(size("3.15.8"), 1116u);
  EXPECT_EQ(size("5.3"), 1108u);
  EXPECT_EQ(size("5.4"), 1116u);
  EXPECT_EQ(size("5.9"), 1116u);
  EXPECT_EQ(size("5.10"), 1220u);
}

TEST(RealtimePacketTest, EndsWithTheElbowOnCb3)
{
  ControllerState state;
  state.elbow_position = Vector3(0.1, 0.2, 0.3);
  state.elbow_velocity = Vector3(-1.0, -2.0, -3.0);
  primary::RealtimePacket packet(*PolyscopeVersion::parse("3.15"));
  const std::string bytes(packet.encode(state));
  EXPECT_EQ(decode_double(bytes.substr(1060, 8)), 0.1);
  EXPECT_EQ(decode_double(bytes.substr(1100, 8)), -3.0);
}

// An example of the Universal Robots Client Library accepts 2 as a valid calibration; UR's simulator sends 0.
TEST(RobotStateVersionTest, CalibrationStatusIsThatOfTheModel)
{
  const RobotModel & nominal = find_robot_model("ur5e")->get();
  const auto status = [](const RobotModel & model) {
    return decode_uint(packages_of(model, "5.25").at(5).substr(216, 4));
  };
  EXPECT_EQ(status(nominal), 0u);
  EXPECT_EQ(status(with_random_calibration(nominal, 1)), 2u);
}

}  // namespace
}  // namespace ur_simulator::testing
