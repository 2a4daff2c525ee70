#include <cmath>

#include "common/pose.hpp"
#include "script_fixture.hpp"

namespace ur_simulator {
namespace {

using urscript::MachineStatus;

Vector6 moved(Vector6 pose, double x, double y, double z)
{
  pose.head<3>() += Vector3(x, y, z);
  return pose;
}

bool said(const ScriptFixture & fixture, const std::string & text)
{
  for (const std::string & message : fixture.host.messages) {
    if (message.find(text) != std::string::npos) {
      return true;
    }
  }
  return false;
}

/// Runs until the program has ended and the arm is at rest. Returns the smallest distance of the TCP from a
/// point, m.
double nearest_until_rest(ScriptFixture & fixture, const Vector6 & point)
{
  double nearest = 1e9;
  fixture.until([&] {
    nearest = std::min(nearest, (fixture.state.target_tcp_pose - point).head<3>().norm());
    return fixture.machine->status() != MachineStatus::running && fixture.arm.at_rest();
  });
  EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
  return nearest;
}

TEST(BlendRadiusTest, CallReturnsInsideTheBlend)
{
  ScriptFixture fixture;
  const Vector6 to = moved(fixture.state.target_tcp_pose, 0.0, 0.2, 0.0);
  fixture.run("def test():\n movel(" + pose_text(to) +
              ", r=0.03)\n global there = get_target_tcp_pose()\n sleep(1)\nend");
  fixture.finish();
  const auto there = fixture.machine->global("there")->vector6();
  ASSERT_TRUE(there);
  EXPECT_NEAR((*there - to).head<3>().norm(), 0.03, 0.001);
  EXPECT_LT((fixture.state.target_tcp_pose - to).head<3>().norm(), 1e-6) << "nothing followed";
}

TEST(BlendRadiusTest, BlendsWithAMotionThatTheProgramComputesInTheBlend)
{
  ScriptFixture fixture;
  const Vector6 from = fixture.state.target_tcp_pose;
  const Vector6 at = moved(from, 0.0, 0.2, 0.0), to = moved(at, 0.0, 0.0, 0.1);
  fixture.run("def test():\n movej(" + pose_text(at) + ", r=0.04)\n if get_standard_digital_in(1):\n movel(" +
              pose_text(from) + ")\n else:\n movel(" + pose_text(to) + ")\n end\nend");
  const double nearest = nearest_until_rest(fixture, at);
  EXPECT_GT(nearest, 0.002);
  EXPECT_LT(nearest, 0.04);
  EXPECT_LT((fixture.state.target_tcp_pose - to).head<3>().norm(), 1e-6);
}

TEST(BlendRadiusTest, OverlappingBlendSkipsTheWaypointWithAWarning)
{
  ScriptFixture fixture;
  const Vector6 from = fixture.state.target_tcp_pose;
  const Vector6 at = moved(from, 0.0, 0.2, 0.0), close = moved(at, 0.05, 0.0, 0.0),
                to = moved(at, 0.0, 0.0, 0.2);
  fixture.run("def test():\n movel(" + pose_text(at) + ", r=0.05)\n movel(" + pose_text(close) +
              ", r=0.02)\n movel(" + pose_text(to) + ")\nend");
  EXPECT_GT(nearest_until_rest(fixture, close), 0.03);
  EXPECT_TRUE(said(fixture, "Overlapping Blends: the waypoint on line 3 is skipped"));
  EXPECT_LT((fixture.state.target_tcp_pose - to).head<3>().norm(), 1e-6);
}

TEST(BlendRadiusTest, IsKeptByAnInterruptedMotion)
{
  ScriptFixture fixture;
  const Vector6 at = moved(fixture.state.target_tcp_pose, 0.0, 0.3, 0.0), to = moved(at, 0.0, 0.0, 0.2);
  fixture.run("def test():\n movel(" + pose_text(at) + ", r=0.04)\n movel(" + pose_text(to) + ")\nend");
  fixture.cycles(300);
  fixture.paused = true;
  fixture.state.safety_mode = SafetyMode::protective_stop;
  fixture.arm.stop_all(20.0);
  fixture.cycles(300);
  EXPECT_TRUE(fixture.arm.at_rest());
  fixture.state.safety_mode = SafetyMode::normal;
  fixture.cycles(1);
  fixture.paused = false;
  const double nearest = nearest_until_rest(fixture, at);
  EXPECT_GT(nearest, 0.005);
  EXPECT_LT(nearest, 0.04);
  EXPECT_LT((fixture.state.target_tcp_pose - to).head<3>().norm(), 1e-6);
}

TEST(MovepTest, PassesItsWaypointsAtConstantSpeed)
{
  ScriptFixture fixture;
  const Vector6 from = fixture.state.target_tcp_pose;
  const Vector6 at = moved(from, 0.0, 0.2, 0.0), to = moved(at, 0.0, 0.0, 0.2);
  fixture.run("def test():\n movep(" + pose_text(at) + ", v=0.2, r=0.05)\n movep(" + pose_text(to) +
              ", v=0.2)\nend");
  fixture.until([&] { return (fixture.state.target_tcp_pose - from).head<3>().norm() > 0.1; });
  double slowest = 1.0;
  fixture.until([&] {
    slowest = std::min(slowest, fixture.state.target_tcp_speed.head<3>().norm());
    return fixture.state.target_tcp_pose[2] - from[2] > 0.1;
  });
  EXPECT_GT(slowest, 0.198);
  fixture.finish();
  EXPECT_LT((fixture.state.target_tcp_pose - to).head<3>().norm(), 1e-6);
}

TEST(MovepTest, AndOtherPathMotionsAcceptJointPositions)
{
  ScriptFixture fixture;
  Vector6 joints = fixture.state.target.position;
  joints[0] += 0.2;
  const Vector6 home = fixture.state.target.position;
  EXPECT_EQ(fixture.error_of("movep(" + list_text(joints) + ")"), "");
  EXPECT_LT((fixture.state.target.position - joints).norm(), 1e-5);
  EXPECT_EQ(fixture.error_of("optimovel(" + list_text(home) + ")"), "");
  EXPECT_LT((fixture.state.target.position - home).norm(), 1e-5);
  EXPECT_EQ(fixture.error_of("optimovej(" + list_text(joints) + ", a=0.5, v=0.5)"), "");
  EXPECT_EQ(fixture.state.target.position, joints);
}

TEST(MovecTest, ContinuesOnItsCircleAfterAProtectiveStop)
{
  for (const int mode : {0, 1}) {
    ScriptFixture fixture;
    const Vector6 from = fixture.state.target_tcp_pose;
    const Vector3 centre = moved(from, -0.15, 0.0, 0.0).head<3>();
    const auto on_circle = [&](double angle) {
      Vector6 pose = from;
      pose.head<3>() = centre + 0.15 * Vector3(std::cos(angle), std::sin(angle), 0.0);
      return pose;
    };
    fixture.run("movec(" + pose_text(on_circle(0.5)) + ", " + pose_text(on_circle(1.5)) +
                ", v=0.15, mode=" + std::to_string(mode) + ")");
    fixture.until([&] { return (fixture.state.target_tcp_pose - on_circle(1.0)).head<3>().norm() < 0.01; });
    fixture.paused = true;
    fixture.state.safety_mode = SafetyMode::protective_stop;
    fixture.arm.stop_all(20.0);
    fixture.cycles(300);
    fixture.state.safety_mode = SafetyMode::normal;
    fixture.cycles(1);
    fixture.paused = false;
    double farthest = 0.0;
    fixture.until([&] {
      const double off = (fixture.state.target_tcp_pose.head<3>() - centre).norm() - 0.15;
      farthest = std::max(farthest, std::abs(off));
      return fixture.machine->status() != MachineStatus::running;
    });
    EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
    EXPECT_LT(farthest, 2e-3) << mode;
    EXPECT_LT((fixture.state.target_tcp_pose - on_circle(1.5)).head<3>().norm(), 1e-6) << mode;
    const Eigen::Matrix3d turned = to_rotation_matrix(fixture.state.target_tcp_pose.tail<3>()) *
                                   to_rotation_matrix(from.tail<3>()).transpose();
    EXPECT_NEAR(to_rotation_vector(turned).norm(), mode == 1 ? 1.5 : 0.0, 1e-5);
  }
}

TEST(ServocTest, InALoopReachesItsTargetAndStaysThere)
{
  ScriptFixture fixture;
  const Vector6 to = moved(fixture.state.target_tcp_pose, 0.0, 0.1, 0.05);
  fixture.run("def test():\n thread servo():\n while True:\n servoc(" + pose_text(to) +
              ", a=1, v=0.2, r=0.01)\n end\n end\n h = run servo()\n sleep(2)\n kill h\n stopl(2)\nend");
  fixture.finish();
  EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
  EXPECT_LT((fixture.state.target_tcp_pose - to).head<3>().norm(), 1e-6);
}

TEST(PathBuiltinsTest, InvalidArgumentsEndTheProgram)
{
  ScriptFixture fixture;
  const Vector6 from = fixture.state.target_tcp_pose;
  const std::string to = pose_text(moved(from, 0.0, 0.1, 0.0));
  const std::string via = pose_text(moved(from, 0.0, 0.05, 0.0));
  const std::string beside = pose_text(moved(from, 0.0, 0.05, 0.05));
  const auto error = [&](const std::string & text) { return fixture.error_of(text); };
  EXPECT_EQ(error("movep(" + to + ", v=0)"), "movep: velocity must be greater than 0, is 0");
  EXPECT_EQ(error("movep(" + to + ", a=-1)"), "movep: acceleration must be greater than 0, is -1");
  EXPECT_NE(error("movep(" + to + ", r=-0.1)").find("movep: blend radius must be in [0, "),
            std::string::npos);
  EXPECT_NE(error("movej(" + list_text(fixture.state.target.position) + ", r=-0.1)").find("blend radius"),
            std::string::npos);
  EXPECT_NE(error("servoc(" + to + ", v=0)").find("servoc: velocity"), std::string::npos);
  EXPECT_NE(error("servoc(p[9, 0, 0, 0, 0, 0])").find("servoc: "), std::string::npos);
  EXPECT_NE(error("movec(" + via + ", " + to + ")").find("must not lie on one line"), std::string::npos);
  EXPECT_EQ(error("movec(" + beside + ", " + to + ", mode=2)"),
            "movec: mode must be 0 (unconstrained) or 1 (fixed), is 2");
  EXPECT_NE(error("optimovel([1, 2])").find("'goal' must be"), std::string::npos);
  EXPECT_NE(error("movec([1, 2], " + to + ")").find("'pose_via' must be"), std::string::npos);
  EXPECT_EQ(error("optimovej(" + list_text(fixture.state.target.position) + ", a=1.4)"),
            "optimovej: a must be in (0, 1], is 1.4");
  const std::string infinite = error("movep([0, 1e308 * 1e308, 0, 0, 0, 0])");
  EXPECT_NE(infinite.find("'pose' must be"), std::string::npos) << infinite;
  EXPECT_TRUE(fixture.arm.at_rest());
}

}  // namespace
}  // namespace ur_simulator
