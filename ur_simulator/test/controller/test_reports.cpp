#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

#include "support/dashboard_client.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

constexpr seconds report_timeout{20};

class ReportTest : public SimulatorTest {
 protected:
  DashboardClient client{controller.address()};
  double simulated_time() { return controller.state()["timestamp"]; }
};

TEST_F(ReportTest, FlightReportTakesTimeAndReturnsId)
{
  const double before = simulated_time();
  EXPECT_EQ(client.request("generate flight report controller", report_timeout),
            "Flight Report generated with id: 1");
  EXPECT_GE(simulated_time() - before, 2.0);
  EXPECT_EQ(client.request("generate flight report system", report_timeout),
            "Flight Report generated with id: 2");
}

TEST_F(ReportTest, RejectsUnknownTypesImmediately)
{
  const double before = simulated_time();
  EXPECT_EQ(client.request("generate flight report everything").substr(0, 6), "Error:");
  EXPECT_EQ(client.request("generate support file no/such/place").substr(0, 6), "Error:");
  EXPECT_LT(simulated_time() - before, 2.0);
}

TEST_F(ReportTest, FlightReportWithoutTypeIsAccepted)
{
  EXPECT_EQ(client.request("generate flight report", report_timeout), "Flight Report generated with id: 1");
}

TEST_F(ReportTest, GeneratesOneReportAtATimeWithoutBlockingOtherClients)
{
  client.socket().send("generate flight report software\nrobotmode\n");
  DashboardClient other(controller.address());
  EXPECT_EQ(other.request("robotmode"), "Robotmode: RUNNING");
  EXPECT_EQ(other.request("generate flight report system"),
            "Error: Another report is already being generated");
  // The next command of the same client is answered after its report.
  EXPECT_EQ(client.socket().receive_line(report_timeout), "Flight Report generated with id: 1");
  EXPECT_EQ(client.socket().receive_line(), "Robotmode: RUNNING");
}

TEST_F(ReportTest, DisconnectedClientDoesNotBlockNextReport)
{
  {
    DashboardClient disconnecting(controller.address());
    disconnecting.socket().send("robotmode\ngenerate flight report system\n");
    EXPECT_EQ(disconnecting.socket().receive_line(), "Robotmode: RUNNING");
    EXPECT_EQ(client.request("generate flight report system").substr(0, 6), "Error:");
  }
  ASSERT_TRUE(wait_simulated_time(controller, 2.1, report_timeout));
  EXPECT_EQ(client.request("generate flight report system", report_timeout).substr(0, 21),
            "Flight Report generat");
}

TEST_F(ReportTest, SavesLog)
{
  EXPECT_EQ(client.request("saveLog"), "Log saved to disk");
}

TEST(ReportsFolderTest, ContainsZipArchiveOfReports)
{
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("reports-" + unique_address());
  SimulatorOptions options;
  options.reports_folder = folder.string();
  SimulatedController controller(with_unique_address(options));
  DashboardClient client(controller.address());
  const std::string reply = client.request("generate support file /programs", report_timeout);
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

}  // namespace
}  // namespace ur_simulator::testing
