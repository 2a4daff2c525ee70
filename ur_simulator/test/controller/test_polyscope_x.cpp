#include <algorithm>
#include <string>
#include <vector>

#include "support/dashboard_client.hpp"
#include "support/polyscope_x_test.hpp"
#include "support/primary_client.hpp"
#include "support/rtde_client.hpp"

namespace ur_simulator::testing {
namespace {

class PolyscopeXInterfacesTest : public PolyscopeXTest {};

TEST_F(PolyscopeXInterfacesTest, HasNoDashboardServer)
{
  EXPECT_EQ(controller.ports().dashboard, 0);
  EXPECT_THROW(DashboardClient(controller.address()), std::runtime_error);
}

TEST_F(PolyscopeXInterfacesTest, ReportsVersionOverRtdeAndPrimaryInterface)
{
  RtdeClient rtde(controller.address());
  EXPECT_EQ(rtde.request('v', ""), encode_uint(10, 4) + encode_uint(14, 4) + encode_uint(0, 8));
  PrimaryClient primary(controller.address(), 30001);
  const std::string message = primary.receive_robot_message(3);
  EXPECT_NE(message.find(std::string("URControl") + "\x0a\x0e"), std::string::npos);
}

// The outputs are those of the version of PolyScope 5 with the same controller.
TEST_F(PolyscopeXInterfacesTest, HasOutputsOfItsController)
{
  RtdeClient rtde(controller.address());
  ASSERT_TRUE(rtde.negotiate(2));
  EXPECT_EQ(rtde.setup_outputs(500.0, "target_gravity,actual_q").substr(1), "VECTOR3D,VECTOR6D");
  SimulatedController older(polyscope_x_options("10.12.1"));
  RtdeClient older_rtde(older.address());
  ASSERT_TRUE(older_rtde.negotiate(2));
  EXPECT_EQ(older_rtde.setup_outputs(500.0, "target_gravity").substr(1), "NOT_FOUND");
}

TEST_F(PolyscopeXInterfacesTest, RejectsScriptsInLocalControl)
{
  controller.control({{"command", "remote_control"}, {"on", false}});
  TcpClient script(controller.address(), 30003);
  script.send("def mine():\n  sync()\nend\n");
  EXPECT_TRUE(wait_for_log(controller, "script was not started: the robot is in local control"));
}

TEST_F(PolyscopeXInterfacesTest, FaultsOfTheControlPortApplyToTheRobotApi)
{
  EXPECT_EQ(client.get("/openapi.json").status, 200);
  EXPECT_EQ(controller.control({{"command", "drop_links"}, {"which", "robot_api"}})["connections"], 1);
  EXPECT_TRUE(client.socket().closed_by_peer());
}

// First versions of the operations: Universal Robots Client Library, version table of the dashboard client.
TEST(PolyscopeXVersionsTest, OffersOperationsOfVersion)
{
  struct Operation {
    const char * path;
    unsigned since;
  };
  const std::vector<Operation> operations{
      {"/program/v1/state", 11},        {"/system/v1/system-time", 11},
      {"/robotstate/v1/robotmode", 12}, {"/robotstate/v1/safetymode", 12},
      {"/program/v1/loaded", 12},       {"/programs/v1/", 12},
      {"/system/v1/controlmode", 12},   {"/system/v1/operationalmode", 12},
      {"/system/v1/information", 14},   {"/versions/v1", 14},
      {"/supportfiles/v1", 14}};
  const std::vector<std::string> api_versions{"2.0.0", "3.1.4", "4.0.0", "5.0.107", "5.0.107"};
  for (unsigned minor = 11; minor <= 15; ++minor) {
    SimulatedController controller(polyscope_x_options("10." + std::to_string(minor) + ".0"));
    HttpClient client(controller.address(), controller.ports().robot_api);
    for (const Operation & operation : operations) {
      EXPECT_EQ(client.get(operation.path).status == 404, minor < operation.since) << minor << operation.path;
    }
    EXPECT_EQ(client.get("/openapi.json").json()["info"]["version"], api_versions[minor - 11]);
    EXPECT_EQ(client.put("/program/v1/load", {{"programName", "Default program"}}).status, 200);
  }
}

TEST(PolyscopeXVersionsTest, EarlierVersionsHaveNoRobotApi)
{
  const SimulatedController controller(polyscope_x_options("10.7.0"));
  EXPECT_EQ(controller.ports().robot_api, 0);
  EXPECT_EQ(controller.ports().dashboard, 0);
  const SimulatedController polyscope_5(with_unique_address());
  EXPECT_EQ(polyscope_5.ports().robot_api, 0);
}

TEST(PolyscopeXVersionsTest, RejectsOtherVersionsAndModels)
{
  const auto error = [](const std::string & model, const std::string & version) -> std::string {
    SimulatorOptions options = polyscope_x_options(version);
    options.model = model;
    try {
      const SimulatedController controller(options);
      return "";
    } catch (const std::runtime_error & failure) {
      return failure.what();
    }
  };
  EXPECT_NE(error("ur5", "10.12").find("model ur5 does not run PolyScope 10.12"), std::string::npos);
  EXPECT_NE(error("ur5e", "10.6").find("10.7 or later"), std::string::npos);
  EXPECT_NE(error("ur5e", "11.0").find("is not supported"), std::string::npos);
  for (const char * model : {"ur3e", "ur7e", "ur8long", "ur12e", "ur15", "ur18", "ur20", "ur30"}) {
    EXPECT_EQ(error(model, "10.12"), "") << model;
  }
}

}  // namespace
}  // namespace ur_simulator::testing
