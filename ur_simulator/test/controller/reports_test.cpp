#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

#include "support/dashboard_client.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

constexpr seconds patience{20};

class Reports : public SimulatorTest {
 protected:
  DashboardClient client{controller.address()};
  double now() { return controller.state()["timestamp"]; }
};

TEST_F(Reports, a_flight_report_takes_its_time_and_gets_a_number)
{
  const double before = now();
  EXPECT_EQ(client.ask("generate flight report controller", patience), "Flight Report generated with id: 1");
  EXPECT_GE(now() - before, 2.0);
  EXPECT_EQ(client.ask("generate flight report system", patience), "Flight Report generated with id: 2");
}

TEST_F(Reports, a_report_of_unknown_type_is_an_error_at_once)
{
  const double before = now();
  EXPECT_EQ(client.ask("generate flight report everything").substr(0, 6), "Error:");
  EXPECT_EQ(client.ask("generate flight report").substr(0, 6), "Error:");
  EXPECT_EQ(client.ask("generate support file no/such/place").substr(0, 6), "Error:");
  EXPECT_LT(now() - before, 2.0);
}

TEST_F(Reports, one_is_written_at_a_time_and_others_are_answered_meanwhile)
{
  client.socket().send("generate flight report software\nrobotmode\n");
  DashboardClient other(controller.address());
  EXPECT_EQ(other.ask("robotmode"), "Robotmode: RUNNING");
  EXPECT_EQ(other.ask("generate flight report system"), "Error: Another report is already being generated");
  // The same client's next question is answered after its report.
  EXPECT_EQ(client.socket().receive_line(patience), "Flight Report generated with id: 1");
  EXPECT_EQ(client.socket().receive_line(), "Robotmode: RUNNING");
}

TEST_F(Reports, a_client_that_leaves_does_not_block_the_next_report)
{
  {
    DashboardClient hasty(controller.address());
    hasty.socket().send("robotmode\ngenerate flight report system\n");
    EXPECT_EQ(hasty.socket().receive_line(), "Robotmode: RUNNING");
    EXPECT_EQ(client.ask("generate flight report system").substr(0, 6), "Error:");
  }
  const double since = now();
  ASSERT_TRUE(controller.wait_until(
      [&](const json & state) { return state["timestamp"].get<double>() > since + 2.1; }, patience));
  EXPECT_EQ(client.ask("generate flight report system", patience).substr(0, 21), "Flight Report generat");
}

TEST_F(Reports, the_log_is_saved)
{
  EXPECT_EQ(client.ask("saveLog"), "Log saved to disk");
}

TEST(ReportsFolder, holds_a_zip_archive_of_the_reports)
{
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("reports-" + next_address());
  SimulatorOptions options;
  options.reports_folder = folder.string();
  SimulatedController controller(on_own_address(options));
  DashboardClient client(controller.address());
  const std::string reply = client.ask("generate support file /programs", patience);
  std::smatch match;
  ASSERT_TRUE(std::regex_match(reply, match,
                               std::regex(R"(Completed successfully: /programs/(ur_\d+_[\d_-]+\.zip))")))
      << reply;
  std::ifstream file(folder / match[1].str(), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(bytes.substr(0, 4), "PK\x03\x04");
  EXPECT_NE(bytes.find("flightreports/1_system.txt"), std::string::npos);
  EXPECT_NE(bytes.find("robot mode: RUNNING"), std::string::npos);
  EXPECT_EQ(bytes.substr(bytes.size() - 22, 4), "PK\x05\x06");
  std::filesystem::remove_all(folder);
}

class OperationalMode : public SimulatorTest {
 protected:
  DashboardClient client{controller.address()};
};

TEST_F(OperationalMode, is_set_asked_for_and_cleared)
{
  EXPECT_EQ(client.ask("get operational mode"), "NONE");
  EXPECT_EQ(client.ask("set operational mode manual"), "Operational mode 'manual' is set");
  EXPECT_EQ(client.ask("get operational mode"), "MANUAL");
  EXPECT_EQ(client.ask("set operational mode automatic"), "Operational mode 'automatic' is set");
  EXPECT_EQ(client.ask("set operational mode sleepy"), "Failed setting operational mode: sleepy");
  EXPECT_EQ(client.ask("clear operational mode").substr(0, 42), "No longer controlling the operational mode");
  EXPECT_EQ(client.ask("get operational mode"), "NONE");
}

TEST_F(OperationalMode, manual_lets_nothing_start_from_afar)
{
  controller.control({{"command", "store_program"},
                      {"name", "wait.urp"},
                      {"script", "def wait():\n while True:\n  sync()\n end\nend\n"},
                      {"load", true}});
  EXPECT_EQ(client.ask("set operational mode manual"), "Operational mode 'manual' is set");
  EXPECT_EQ(client.ask("play"), "Failed to execute: play");
  RawSocket script(controller.address(), 30002);
  script.send("def mine():\n while True:\n  sync()\n end\nend\n");
  EXPECT_TRUE(wait_for_log(controller, "script was not started: the operational mode"));
  EXPECT_EQ(client.ask("running"), "Program running: false");
  EXPECT_EQ(client.ask("clear operational mode").substr(0, 2), "No");
  EXPECT_EQ(client.ask("play"), "Starting program");
}

TEST_F(OperationalMode, installations_are_loaded_by_name)
{
  EXPECT_EQ(client.ask("load installation default.installation"),
            "Loading installation: default.installation");
  EXPECT_EQ(client.ask("load installation cell.installation"), "File not found: cell.installation");
  controller.control({{"command", "store_program"}, {"name", "cell.installation"}, {"script", ""}});
  EXPECT_EQ(client.ask("load installation cell.installation"), "Loading installation: cell.installation");
}

}  // namespace
}  // namespace ur_simulator::testing
