#include "kinematics/forward_kinematics.hpp"
#include "script_fixture.hpp"

namespace ur_simulator {
namespace {

// Wrist positions with four orientations of the flange, as an operator chooses them.
constexpr const char * joint_positions =
    "[[0, -1.57, 1.57, -1.57, -1.57, 0], [0, -1.57, 1.57, -0.8, -1.57, 1.2], "
    "[0, -1.57, 1.57, -1.57, -0.6, -1.2], [0, -1.57, 1.57, -2.4, -2.4, 0.6]]";

// Measures at these positions; `position` is the call that gives the element of the list of poses.
std::string measurement(const std::string & position)
{
  return R"(def test():
    set_tcp(p[0.01, -0.02, 0.15, 0.3, 0, 0])
    targets = )" +
         std::string(joint_positions) + R"(
    poses = []
    wrenches = []
    while length(poses) < 4:
      movej(targets[length(poses)], a=4, v=2)
      sleep(0.5)
      poses.append()" +
         position + R"()
      wrenches.append(get_tcp_force())
    end
    payload = estimate_payload(poses, wrenches)
    set_payload(payload.mass, payload.cog)
  end)";
}

class EstimatePayloadTest : public ::testing::Test {
 protected:
  EstimatePayloadTest()
  {
    load.mass = 2.5;
    load.center_of_gravity = Vector3(0.03, -0.04, 0.08);
    fixture.world.attach_load(load);
  }

  void expect_load() const
  {
    EXPECT_NEAR(fixture.state.payload.mass, load.mass, 1e-3);
    EXPECT_LT((fixture.state.payload.center_of_gravity - load.center_of_gravity).norm(), 1e-3)
        << fixture.state.payload.center_of_gravity.transpose();
  }

  /// The error of a call with these poses and as many wrenches.
  std::string error_with_poses(const std::string & poses)
  {
    return fixture.error_of("def test():\n  poses = " + poses +
                            "\n  wrenches = []\n  while wrenches.length() < length(poses):\n"
                            "    wrenches.append([0, 0, 10, 0, 0, 0])\n  end\n"
                            "  x = estimate_payload(poses, wrenches)\nend");
  }

  Payload load;
  ScriptFixture fixture;
};

TEST_F(EstimatePayloadTest, FindsLoadFromTcpPoses)
{
  EXPECT_EQ(fixture.error_of(measurement("get_actual_tcp_pose()")), "");
  expect_load();
}

TEST_F(EstimatePayloadTest, FindsLoadFromJointPositions)
{
  EXPECT_EQ(fixture.error_of(measurement("get_actual_joint_positions()")), "");
  expect_load();
}

TEST_F(EstimatePayloadTest, IncludesActivePayloadThatTheWrenchesDoNotContain)
{
  fixture.state.payload.mass = 4.0;
  fixture.state.payload.center_of_gravity = Vector3(0.0, 0.1, 0.0);
  EXPECT_EQ(fixture.error_of(measurement("get_actual_tcp_pose()")), "");
  expect_load();
}

TEST_F(EstimatePayloadTest, ZeroOfTheSensorHasNoEffect)
{
  fixture.cycles(100);
  fixture.world.zero_sensor();
  EXPECT_EQ(fixture.error_of(measurement("get_actual_tcp_pose()")), "");
  expect_load();
}

TEST_F(EstimatePayloadTest, WithoutLoadIsNothing)
{
  load = Payload();
  fixture.world.attach_load(load);
  EXPECT_EQ(fixture.error_of(measurement("get_actual_tcp_pose()")), "");
  EXPECT_NEAR(fixture.state.payload.mass, 0.0, 1e-3);
}

TEST_F(EstimatePayloadTest, RejectsPosesThatAreTooFewOrTooSimilar)
{
  EXPECT_EQ(error_with_poses("[p[0, 0, 0, 0, 0, 0], p[0, 0, 0, 1, 0, 0], p[0, 0, 0, 0, 1, 0]]"),
            "estimate_payload: poses must have 4 to 100 elements, not 3");
  EXPECT_EQ(error_with_poses(
                "[p[0, 0, 0, 0, 0, 0], p[0, 0, 0, 1, 0, 0], p[0, 0, 0, 0, 1, 0], p[0, 0, 0, 1.3, 0, 0]]"),
            "estimate_payload: the orientations of poses[1] and poses[3] differ by 0.300 rad: it must be at "
            "least 0.393 rad");
}

TEST_F(EstimatePayloadTest, RejectsPosesWithOneDirectionOfGravity)
{
  EXPECT_EQ(error_with_poses(
                "[p[0, 0, 0, 0, 0, 0], p[0, 0, 0, 0, 0, 1], p[0, 0, 0, 0, 0, 2], p[0, 0, 0, 0, 0, 3]]"),
            "estimate_payload: the poses do not determine the payload: tilt the flange about two axes");
}

TEST_F(EstimatePayloadTest, RejectsWrongArguments)
{
  const std::string poses = joint_positions;
  EXPECT_EQ(fixture.error_of("def test():\n  x = estimate_payload(" + poses + ", [[0, 0, 1, 0, 0, 0]])\nend"),
            "estimate_payload: wrenches must have as many elements as poses: 4, not 1");
  EXPECT_EQ(fixture.error_of("def test():\n  x = estimate_payload(3, [])\nend"),
            "estimate_payload: the argument 'poses' must be a list of poses or of lists of six numbers");
  EXPECT_EQ(fixture.error_of("def test():\n  x = estimate_payload([p[0, 0, 0, 0, 0, 0], 3], [])\nend"),
            "estimate_payload: poses[1] must be a pose or a list of six numbers");
}

}  // namespace
}  // namespace ur_simulator
