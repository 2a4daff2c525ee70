#include "support/dashboard_client.hpp"
#include "support/simulator_test.hpp"
#include "support/single_reply_server.hpp"

namespace ur_simulator::testing {
namespace {

class ExternalControlTest : public SimulatorTest {
 protected:
  void load_external_control(std::uint16_t port)
  {
    const json reply = controller.control(
        {{"command", "store_external_control"}, {"host", controller.address()}, {"port", port}});
    ASSERT_TRUE(reply["ok"]) << reply.dump();
  }
  bool wait_for_popup(const std::string & text)
  {
    return controller.wait_until(
        [&](const json & state) {
          return state["popup"].is_string() &&
                 state["popup"].get<std::string>().find(text) != std::string::npos;
        },
        seconds(15));
  }
  DashboardClient dashboard{controller.address()};
};

TEST_F(ExternalControlTest, RunsProgramOfHost)
{
  SingleReplyServer host(controller.address());
  load_external_control(host.port());
  EXPECT_EQ(dashboard.request("get loaded program"), "Loaded program: /programs/external_control.urp");
  dashboard.socket().send("play\n");
  EXPECT_EQ(host.receive_request(), "request_program\n");
  ASSERT_TRUE(
      host.send_reply("# HEADER_BEGIN\ndef helper():\n  return 3\nend\n# HEADER_END\n"
                      "set_standard_digital_out(helper(), True)\nwhile True:\n  sync()\nend\n"));
  EXPECT_EQ(dashboard.socket().receive_line(seconds(10)), "Starting program");
  EXPECT_TRUE(controller.wait_until(
      [](const json & state) {
        return state["io"]["digital_outputs"] == 8 && state["program"]["state"] == "PLAYING";
      },
      seconds(5)));
  EXPECT_EQ(dashboard.request("programState"), "PLAYING external_control.urp");
}

TEST_F(ExternalControlTest, RequestsProgramAtEachStart)
{
  for (const char * output : {"1", "2"}) {
    SingleReplyServer host(controller.address());
    load_external_control(host.port());
    dashboard.socket().send("play\n");
    ASSERT_EQ(host.receive_request(), "request_program\n");
    ASSERT_TRUE(host.send_reply(std::string("set_standard_digital_out(") + output + ", True)\n"));
    EXPECT_EQ(dashboard.socket().receive_line(seconds(10)), "Starting program");
    ASSERT_TRUE(wait_for_program_state(controller, "STOPPED"));
  }
  EXPECT_EQ(controller.state()["io"]["digital_outputs"], 6);
}

TEST_F(ExternalControlTest, ShowsPopupIfHostRefusesConnection)
{
  std::uint16_t unused = 0;
  {
    const SingleReplyServer host(controller.address());
    unused = host.port();
  }
  load_external_control(unused);
  EXPECT_EQ(dashboard.request("play", seconds(10)), "Starting program");
  EXPECT_TRUE(wait_for_popup("could not be established"));
  EXPECT_EQ(controller.state()["program"]["state"], "PLAYING");
  EXPECT_EQ(dashboard.request("close popup"), "closing popup");
  EXPECT_TRUE(wait_for_program_state(controller, "STOPPED"));
}

TEST_F(ExternalControlTest, ShowsPopupIfHostDoesNotReply)
{
  SingleReplyServer host(controller.address());
  load_external_control(host.port());
  dashboard.socket().send("play\n");
  ASSERT_EQ(host.receive_request(), "request_program\n");
  EXPECT_EQ(dashboard.socket().receive_line(seconds(15)), "Starting program");
  EXPECT_TRUE(wait_for_popup("nothing was received"));
}

TEST_F(ExternalControlTest, RejectsProgramThatDoesNotCompile)
{
  SingleReplyServer host(controller.address());
  load_external_control(host.port());
  dashboard.socket().send("play\n");
  ASSERT_EQ(host.receive_request(), "request_program\n");
  ASSERT_TRUE(host.send_reply("no_such_function()\n"));
  EXPECT_EQ(dashboard.socket().receive_line(seconds(10)), "Failed to execute: play");
  EXPECT_TRUE(log_contains(controller, "no_such_function"));
}

TEST_F(ExternalControlTest, RequestsNoProgramWhilePoweredOff)
{
  load_external_control(1);
  controller.control({{"command", "power"}, {"to", "off"}});
  ASSERT_TRUE(wait_for_robot_mode(controller, "POWER_OFF", seconds(10)));
  EXPECT_EQ(dashboard.request("play"), "Failed to execute: play");
}

}  // namespace
}  // namespace ur_simulator::testing
