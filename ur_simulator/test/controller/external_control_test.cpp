#include "support/dashboard_client.hpp"
#include "support/one_answer.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

class ExternalControl : public SimulatorTest {
 protected:
  void load(std::uint16_t port)
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

TEST_F(ExternalControl, runs_what_the_host_answers)
{
  OneAnswer host(controller.address());
  load(host.port());
  EXPECT_EQ(dashboard.ask("get loaded program"), "Loaded program: /programs/external_control.urp");
  dashboard.socket().send("play\n");
  EXPECT_EQ(host.request(), "request_program\n");
  ASSERT_TRUE(
      host.answer("# HEADER_BEGIN\ndef helper():\n  return 3\nend\n# HEADER_END\n"
                  "set_standard_digital_out(helper(), True)\nwhile True:\n  sync()\nend\n"));
  EXPECT_EQ(dashboard.socket().receive_line(seconds(10)), "Starting program");
  EXPECT_TRUE(controller.wait_until(
      [](const json & state) {
        return state["io"]["digital_outputs"] == 8 && state["program"]["state"] == "PLAYING";
      },
      seconds(5)));
  EXPECT_EQ(dashboard.ask("programState"), "PLAYING external_control.urp");
}

TEST_F(ExternalControl, asks_the_host_again_at_every_start)
{
  for (const char * output : {"1", "2"}) {
    OneAnswer host(controller.address());
    load(host.port());
    dashboard.socket().send("play\n");
    ASSERT_EQ(host.request(), "request_program\n");
    ASSERT_TRUE(host.answer(std::string("set_standard_digital_out(") + output + ", True)\n"));
    EXPECT_EQ(dashboard.socket().receive_line(seconds(10)), "Starting program");
    ASSERT_TRUE(wait_for_program(controller, "STOPPED"));
  }
  EXPECT_EQ(controller.state()["io"]["digital_outputs"], 6);
}

TEST_F(ExternalControl, shows_a_popup_when_the_host_refuses_the_connection)
{
  std::uint16_t unused = 0;
  {
    const OneAnswer host(controller.address());
    unused = host.port();
  }
  load(unused);
  EXPECT_EQ(dashboard.ask("play", seconds(10)), "Starting program");
  EXPECT_TRUE(wait_for_popup("could not be established"));
  EXPECT_EQ(controller.state()["program"]["state"], "PLAYING");
  EXPECT_EQ(dashboard.ask("close popup"), "closing popup");
  EXPECT_TRUE(wait_for_program(controller, "STOPPED"));
}

TEST_F(ExternalControl, shows_a_popup_when_the_host_says_nothing)
{
  OneAnswer host(controller.address());
  load(host.port());
  dashboard.socket().send("play\n");
  ASSERT_EQ(host.request(), "request_program\n");
  EXPECT_EQ(dashboard.socket().receive_line(seconds(15)), "Starting program");
  EXPECT_TRUE(wait_for_popup("nothing was received"));
}

TEST_F(ExternalControl, refuses_a_program_that_does_not_compile)
{
  OneAnswer host(controller.address());
  load(host.port());
  dashboard.socket().send("play\n");
  ASSERT_EQ(host.request(), "request_program\n");
  ASSERT_TRUE(host.answer("no_such_function()\n"));
  EXPECT_EQ(dashboard.socket().receive_line(seconds(10)), "Failed to execute: play");
  EXPECT_TRUE(logged(controller, "no_such_function"));
}

TEST_F(ExternalControl, asks_no_host_while_the_robot_is_off)
{
  load(1);
  controller.control({{"command", "power"}, {"to", "off"}});
  ASSERT_TRUE(controller.wait_until([](const json & state) { return state["robot_mode"] == "POWER_OFF"; },
                                    seconds(10)));
  EXPECT_EQ(dashboard.ask("play"), "Failed to execute: play");
}

}  // namespace
}  // namespace ur_simulator::testing
