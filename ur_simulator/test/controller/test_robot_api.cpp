#include "support/polyscope_x_test.hpp"

namespace ur_simulator::testing {
namespace {

constexpr const char * endless_program = "def endless():\n  while True:\n    sync()\n  end\nend\n";

class RobotApiTest : public PolyscopeXTest {
 protected:
  HttpReply change_robot(const std::string & action)
  {
    return client.put("/robotstate/v1/state", {{"action", action}});
  }
  HttpReply change_program(const std::string & action)
  {
    return client.put("/program/v1/state", {{"action", action}});
  }
  std::string mode(const std::string & path) { return client.get(path).json().at("mode"); }
};

TEST_F(RobotApiTest, ReportsModesAndIdentity)
{
  EXPECT_EQ(mode("/robotstate/v1/robotmode"), "RUNNING");
  EXPECT_EQ(mode("/robotstate/v1/safetymode"), "NORMAL");
  EXPECT_EQ(mode("/system/v1/controlmode"), "REMOTE");
  EXPECT_EQ(mode("/system/v1/operationalmode"), "AUTOMATIC");
  EXPECT_EQ(client.get("/system/v1/information").json()["robotType"], "UR10");
  EXPECT_EQ(client.get("/versions/v1").json()["marketingVersion"], "10.14.0");
  EXPECT_EQ(client.get("/system/v1/system-time").status, 200);
}

TEST_F(RobotApiTest, RepliesWhenRobotHasReachedState)
{
  const HttpReply off = change_robot("POWER_OFF");
  EXPECT_EQ(off.status, 200) << off.body;
  EXPECT_EQ(off.json()["state"], "POWER_OFF");
  EXPECT_EQ(mode("/robotstate/v1/robotmode"), "POWER_OFF");
  EXPECT_EQ(change_robot("POWER_ON").json()["state"], "IDLE");
  EXPECT_EQ(mode("/robotstate/v1/robotmode"), "IDLE");
  EXPECT_EQ(change_robot("BRAKE_RELEASE").json()["state"], "RUNNING");
}

TEST_F(RobotApiTest, ServesOthersWhileOneWaits)
{
  ASSERT_EQ(change_robot("POWER_OFF").status, 200);
  client.socket().send(
      "PUT /universal-robots/robot-api/robotstate/v1/state HTTP/1.1\r\nHost: robot\r\nContent-Length: "
      "21\r\n\r\n"
      "{\"action\":\"POWER_ON\"}\n");
  HttpClient other(controller.address(), controller.ports().robot_api);
  EXPECT_EQ(other.get("/robotstate/v1/robotmode").status, 200);
  EXPECT_EQ(client.receive().json()["state"], "IDLE");
}

TEST_F(RobotApiTest, UnlocksProtectiveStop)
{
  const HttpReply rejected = change_robot("UNLOCK_PROTECTIVE_STOP");
  EXPECT_EQ(rejected.status, 409);
  EXPECT_EQ(rejected.json()["message"], "Conflict");
  controller.control({{"command", "protective_stop"}, {"reason", "a test"}});
  ASSERT_TRUE(wait_for_safety_mode(controller, "PROTECTIVE_STOP", seconds(10)));
  EXPECT_EQ(mode("/robotstate/v1/safetymode"), "PROTECTIVE_STOP");
  EXPECT_EQ(change_robot("UNLOCK_PROTECTIVE_STOP").status, 200);
  EXPECT_EQ(mode("/robotstate/v1/safetymode"), "NORMAL");
}

TEST_F(RobotApiTest, RestartsSafety)
{
  controller.control({{"command", "violation"}, {"reason", "a test"}});
  ASSERT_TRUE(wait_for_safety_mode(controller, "VIOLATION", seconds(10)));
  EXPECT_EQ(mode("/robotstate/v1/safetymode"), "FAULT");
  EXPECT_EQ(change_robot("POWER_ON").status, 409);
  EXPECT_EQ(change_robot("RESTART_SAFETY").json()["state"], "POWER_OFF");
  EXPECT_EQ(mode("/robotstate/v1/safetymode"), "NORMAL");
}

TEST_F(RobotApiTest, LoadsPlaysPausesAndStopsProgram)
{
  EXPECT_EQ(client.get("/program/v1/loaded").json()["name"], "Default program");
  store_program("endless", endless_program);
  EXPECT_EQ(client.put("/program/v1/loaded", {{"name", "endless"}}).status, 200);
  EXPECT_EQ(client.get("/program/v1/loaded").json()["name"], "endless");
  EXPECT_EQ(change_program("play").json()["state"], "PLAYING");
  EXPECT_EQ(client.get("/program/v1/state").json()["state"], "PLAYING");
  const HttpReply paused = change_program("pause");
  EXPECT_EQ(paused.body,
            R"({"details":"Pause successful","message":"Program state changed: PAUSED","state":"PAUSED"})");
  EXPECT_EQ(change_program("resume").json()["state"], "PLAYING");
  EXPECT_EQ(change_program("stop").json()["state"], "STOPPED");
  EXPECT_EQ(change_program("pause").status, 500);
}

TEST_F(RobotApiTest, RejectsMissingAndInvalidPrograms)
{
  store_program("broken", "def broken(:\n");
  EXPECT_EQ(client.put("/program/v1/loaded", {{"name", "missing"}}).status, 404);
  EXPECT_EQ(client.put("/program/v1/loaded", {{"name", "broken"}}).status, 500);
  EXPECT_EQ(client.put("/program/v1/load", {{"programName", "missing"}}).status, 500);
  EXPECT_EQ(client.put("/program/v1/load", {{"programName", "Default program"}}).status, 200);
}

TEST_F(RobotApiTest, RequiresRemoteControlForCommandsOnly)
{
  ASSERT_TRUE(controller.control({{"command", "remote_control"}, {"on", false}})["ok"]);
  EXPECT_EQ(mode("/system/v1/controlmode"), "LOCAL");
  EXPECT_EQ(client.get("/programs/v1/").status, 200);
  const HttpReply rejected = change_robot("POWER_OFF");
  EXPECT_EQ(rejected.status, 403);
  EXPECT_EQ(rejected.json()["message"], "Forbidden");
  EXPECT_EQ(change_program("play").status, 403);
  EXPECT_EQ(client.put("/program/v1/loaded", {{"name", "x"}}).status, 403);
  EXPECT_EQ(client.post("/popup/v1", {{"message", "x"}}).status, 403);
  EXPECT_EQ(client.post("/system/v1/log", {{"message", "x"}}).status, 403);
  EXPECT_EQ(client.post("/supportfiles/v1", {}).status, 403);
  EXPECT_EQ(client.put("/system/v1/shutdown", {}).status, 403);
}

TEST_F(RobotApiTest, ManualModeEndsRemoteControl)
{
  ASSERT_TRUE(controller.control({{"command", "operational_mode"}, {"mode", "MANUAL"}})["ok"]);
  EXPECT_EQ(mode("/system/v1/operationalmode"), "MANUAL");
  EXPECT_EQ(mode("/system/v1/controlmode"), "LOCAL");
  EXPECT_EQ(change_robot("POWER_OFF").status, 403);
  EXPECT_FALSE(controller.control({{"command", "remote_control"}})["ok"]);
  controller.control({{"command", "operational_mode"}, {"mode", "AUTOMATIC"}});
  EXPECT_EQ(mode("/system/v1/controlmode"), "LOCAL");
  EXPECT_TRUE(controller.control({{"command", "remote_control"}})["ok"]);
}

TEST_F(RobotApiTest, OpensAndClosesPopups)
{
  EXPECT_EQ(client.request("DELETE", "/popup/v1").json()["closed"], false);
  const HttpReply opened = client.post("/popup/v1", {{"message", "text"}, {"title", "heading"}});
  EXPECT_EQ(opened.json()["message"], "Popup opened successfully");
  EXPECT_EQ(controller.state()["popup"], "text");
  const HttpReply closed = client.request("DELETE", "/popup/v1");
  EXPECT_EQ(closed.status, 200);
  EXPECT_EQ(closed.json()["closed"], true);
  EXPECT_TRUE(controller.state()["popup"].is_null());
  EXPECT_EQ(client.request("DELETE", "/popup/v1/safety").status, 404);
  controller.control({{"command", "fault"}, {"reason", "a test"}});
  ASSERT_TRUE(wait_for_safety_mode(controller, "FAULT", seconds(10)));
  ASSERT_TRUE(wait_for_next_cycle(controller));
  EXPECT_EQ(client.request("DELETE", "/popup/v1/safety").status, 200);
}

TEST_F(RobotApiTest, AddsToLogAndShutsDown)
{
  EXPECT_EQ(client.post("/system/v1/log", {{"message", "from the cell"}}).json()["message"],
            "Log entry added");
  EXPECT_TRUE(log_contains(controller, "from the cell"));
  EXPECT_EQ(client.request("PUT", "/system/v1/shutdown").status, 202);
  EXPECT_TRUE(wait_for_log(controller, "switched off"));
  EXPECT_TRUE(client.socket().closed_by_peer());
}

TEST_F(RobotApiTest, GeneratesFlightReports)
{
  EXPECT_EQ(client.get("/supportfiles/v1").status, 204);
  client.socket().send("POST /universal-robots/robot-api/supportfiles/v1 HTTP/1.1\r\nHost: robot\r\n\r\n");
  HttpClient other(controller.address(), controller.ports().robot_api);
  // One report at a time: one client has to try again.
  HttpReply first = other.post("/supportfiles/v1", {});
  HttpReply second = client.receive();
  if (first.status == 429) {
    std::swap(first, second);
  }
  EXPECT_EQ(first.status, 200);
  EXPECT_EQ(first.json()["message"], "Flight report generated successfully.");
  EXPECT_EQ(second.status, 429);
  const HttpReply archive = client.get("/supportfiles/v1");
  EXPECT_EQ(archive.headers.at("content-type"), "application/zip");
  EXPECT_EQ(archive.body.substr(0, 4), "PK\x03\x04");
}

}  // namespace
}  // namespace ur_simulator::testing
