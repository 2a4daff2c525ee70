#include "support/polyscope_x_test.hpp"

namespace ur_simulator::testing {
namespace {

class RobotApiProgramsTest : public PolyscopeXTest {
 protected:
  explicit RobotApiProgramsTest(const std::string & version = "10.14.0") : PolyscopeXTest(version) {}

  /// A .urpx file with what the Robot API and the simulator read from it.
  static std::string urpx(const std::string & name, const std::string & script)
  {
    return json{
        {"application", {{"urscript", {{"script", "global speed = 1"}}}}},
        {"program",
         {{"programInformation",
           {{"name", name}, {"description", "a test"}, {"createdDate", 1771239851763}, {"lastSavedDate", 7}}},
          {"urscript", {{"script", script}}}}}}
        .dump();
  }
  HttpReply upload(const std::string & content) { return client.send_file("POST", "/programs/v1/", content); }
  HttpReply update(const std::string & content) { return client.send_file("PUT", "/programs/v1/", content); }
};

class RobotApi1012ProgramsTest : public RobotApiProgramsTest {
 protected:
  RobotApi1012ProgramsTest() : RobotApiProgramsTest("10.12.0") {}
};

TEST_F(RobotApiProgramsTest, UploadedProgramIsListedDownloadedAndPlayed)
{
  const std::string file = urpx("test upload", "$ 1 \"ur-program\"\ntextmsg(\"speed\", speed)\nsleep(1000)");
  const HttpReply uploaded = upload(file);
  ASSERT_EQ(uploaded.status, 200) << uploaded.body;
  EXPECT_EQ(uploaded.json()["programName"], "test upload");
  const json programs = client.get("/programs/v1/").json()["programs"];
  ASSERT_EQ(programs.size(), 2U);
  EXPECT_EQ(programs[0]["name"], "Default program");
  EXPECT_EQ(programs[1]["name"], "test upload");
  EXPECT_EQ(programs[1]["description"], "a test");
  EXPECT_EQ(programs[1]["createdDate"], 1771239851763);
  EXPECT_EQ(client.get("/programs/v1/test%20upload").body, file);
  ASSERT_EQ(client.put("/program/v1/loaded", {{"name", "test upload"}}).status, 200);
  EXPECT_EQ(client.put("/program/v1/state", {{"action", "play"}}).json()["state"], "PLAYING");
  EXPECT_TRUE(wait_for_log(controller, "speed1"));
}

TEST_F(RobotApiProgramsTest, DownloadsStoredScript)
{
  store_program("pick", "def pick():\nend\n");
  const json file = client.get("/programs/v1/pick").json();
  EXPECT_EQ(file["program"]["urscript"]["script"], "def pick():\nend\n");
  EXPECT_EQ(client.get("/programs/v1/place").status, 404);
}

TEST_F(RobotApiProgramsTest, UpdatesOnlyProgramsThatExistAndDoNotRun)
{
  EXPECT_EQ(update(urpx("pick", "sync()")).status, 404);
  ASSERT_EQ(upload(urpx("pick", "sleep(1000)")).status, 200);
  EXPECT_EQ(upload(urpx("pick", "sync()")).status, 409);
  ASSERT_EQ(client.put("/program/v1/loaded", {{"name", "pick"}}).status, 200);
  ASSERT_EQ(client.put("/program/v1/state", {{"action", "play"}}).status, 200);
  EXPECT_EQ(update(urpx("pick", "sync()")).status, 409);
  ASSERT_EQ(client.put("/program/v1/state", {{"action", "stop"}}).status, 200);
  EXPECT_EQ(update(urpx("pick", "sync()")).status, 200);
  EXPECT_EQ(client.get("/programs/v1/pick").body, urpx("pick", "sync()"));
}

TEST_F(RobotApi1012ProgramsTest, ReportsExistingProgramAsBadRequest)
{
  ASSERT_EQ(upload(urpx("pick", "sync()")).status, 200);
  EXPECT_EQ(upload(urpx("pick", "sync()")).status, 400);
}

TEST_F(RobotApiProgramsTest, RejectsInvalidFiles)
{
  for (const std::string & content : {std::string("no JSON"), std::string("[]"), std::string("{}"),
                                      std::string(R"({"program": {"programInformation": {"name": 3}}})")}) {
    const HttpReply reply = upload(content);
    EXPECT_EQ(reply.status, 422) << content;
    EXPECT_EQ(reply.json()["detail"][0]["loc"], json({"body", "file"}));
  }
  EXPECT_EQ(client.post("/programs/v1/", {{"file", "x"}}).status, 422);
  EXPECT_EQ(client.request("POST", "/programs/v1/", "--xyz\r\n", "multipart/form-data; boundary=xyz").status,
            422);
}

TEST_F(RobotApiProgramsTest, TransfersLargeFile)
{
  const std::string file = urpx("large", "# " + std::string(2 << 20, 'x'));
  ASSERT_EQ(upload(file).status, 200);
  EXPECT_EQ(client.get("/programs/v1/large").body, file);
}

TEST_F(RobotApiProgramsTest, StoresLimitedNumberOfPrograms)
{
  int status = 200;
  for (int i = 0; status == 200 && i < 1000; ++i) {
    status = upload(urpx(std::to_string(i), "sync()")).status;
  }
  EXPECT_EQ(status, 507);
  EXPECT_EQ(client.get("/programs/v1/").json()["programs"].size(), 200U);
}

}  // namespace
}  // namespace ur_simulator::testing
