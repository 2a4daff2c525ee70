// The client log of a session of the ur_rtde library.
#include <ur_rtde/rtde_control_interface.h>
#include <ur_rtde/rtde_receive_interface.h>

#include "support/sequence_diagram.hpp"
#include "support/simulator_test.hpp"
#include "support/temporary_file.hpp"

namespace ur_simulator::testing {
namespace {

using Lines = std::vector<std::string>;

/// Connects both interfaces, moves and disconnects. Returns the log.
Lines log_of_session()
{
  const TemporaryFile file("ur_rtde_log");
  SimulatorOptions options;
  options.client_log = file.path();
  {
    SimulatedController controller(with_unique_address(options));
    {
      ur_rtde::RTDEControlInterface control(controller.address(), -1.0,
                                            ur_rtde::RTDEControlInterface::FLAGS_DEFAULT, 50002, -1);
      ur_rtde::RTDEReceiveInterface receive(controller.address());
      EXPECT_TRUE(control.moveJ({0.1, -1.57, 1.57, -1.57, -1.57, 0.0}, 1.0, 2.0));
      control.stopScript();
      EXPECT_TRUE(wait_for_program_state(controller, "STOPPED"));
    }
    EXPECT_TRUE(
        controller.wait_until([](const json & state) { return state["clients"]["rtde"] == 0; }, seconds(5)));
  }
  return read_diagram(file.path());
}

/// The beginnings of the lines: what follows a colon varies with the version of ur_rtde.
Lines without_values(const Lines & lines)
{
  Lines result;
  for (const std::string & line : lines) {
    result.push_back(line.substr(0, line.find_first_of(":0123456789")));
  }
  return result;
}

/// The positions of lines that contain the texts, in the order of the texts.
void expect_order(const Lines & lines, const Lines & texts)
{
  auto next = lines.begin();
  for (const std::string & text : texts) {
    next = std::find_if(next, lines.end(),
                        [&](const std::string & line) { return line.find(text) != std::string::npos; });
    ASSERT_NE(next, lines.end()) << "missing, or out of order: " << text;
  }
}

TEST(UrRtdeClientLogTest, ShowsSession)
{
  const Lines lines = log_of_session();
  const Lines receive = session_of(lines, "RTDE client 2");
  EXPECT_EQ(without_values(receive),
            (Lines{"> connects from ", "> requests RTDE protocol version ", "< accepted",
                   "> requests the controller version", "< ", "> requests the controller version", "< ",
                   "> requests outputs at ", "< accepted as recipe ", "> start", "< accepted",
                   "< data packages of ", "x> closes the connection", "data packages"}));
  expect_order(lines, {"RTDE client 1->>robot: connects from ",
                       "dashboard client 1->>robot: PolyscopeVersion",
                       "robot-->>dashboard client 1: URSoftware 5.25.1.0",
                       "dashboard client 1->>robot: is in remote control",
                       "robot-->>dashboard client 1: true",
                       "realtime client 1->>robot: connects from ",
                       "RTDE client 1->>robot: requests outputs at 500 Hz: timestamp,robot_status_bits",
                       "robot-->>RTDE client 1: accepted as recipe 1: DOUBLE,UINT32",
                       "RTDE client 1->>robot: requests inputs: input_int_register_0,input_double_register_0",
                       "robot-->>RTDE client 1: accepted as recipe 1: INT32,DOUBLE",
                       "RTDE client 1->>robot: start",
                       "robot-->>RTDE client 1: accepted",
                       "realtime client 1->>robot: script of ",
                       "Note over robot: program: program 'rtde_control' started",
                       "Note over robot,realtime client 1: accepted",
                       "RTDE client 2->>robot: connects from ",
                       "RTDE client 1->>robot: data package of recipe 1: input_int_register_0=1, "
                       "input_double_register_0=0.1,",
                       "Note over robot: textmsg: movej done",
                       "Note over robot: program: program 'rtde_control' ended",
                       "RTDE client 2-xrobot: closes the connection",
                       "RTDE client 1-xrobot: closes the connection",
                       "Note over robot,RTDE client 1: data packages: "});
}

}  // namespace
}  // namespace ur_simulator::testing
