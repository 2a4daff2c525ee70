#include "common/pose.hpp"
#include "kinematics/forward_kinematics.hpp"
#include "script_fixture.hpp"

namespace ur_simulator {
namespace {

using urscript::MachineStatus;

TEST(MovejTest, BlocksUntilTheJointsAreThere)
{
  ScriptFixture fixture;
  Vector6 target = fixture.state.target.position;
  target[0] += 0.5;
  fixture.run("def test():\n movej(" + list_text(target) + ", a=2, v=1)\n done = True\nend");
  const double time = fixture.finish();
  EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
  EXPECT_EQ(fixture.global("done"), "True");
  EXPECT_GT(time, 0.5);
  EXPECT_LT((fixture.state.target.position - target).norm(), 1e-6);
}

TEST(MovejTest, TakesAPoseAsWell)
{
  ScriptFixture fixture;
  Vector6 pose = fixture.state.target_tcp_pose;
  pose[2] += 0.05;
  EXPECT_EQ(fixture.error_of("def test():\n movej(" + pose_text(pose) + ", t=1)\nend"), "");
  EXPECT_LT((fixture.state.target_tcp_pose - pose).head<3>().norm(), 1e-6);
}

TEST(MovelTest, MovesStraightToAPoseOrJoints)
{
  ScriptFixture fixture;
  Vector6 pose = fixture.state.target_tcp_pose;
  pose[1] += 0.1;
  EXPECT_EQ(fixture.error_of("def test():\n movel(" + pose_text(pose) + ")\nend"), "");
  EXPECT_LT((fixture.state.target_tcp_pose - pose).head<3>().norm(), 1e-6);
  const Vector6 home = default_position(fixture.model);
  EXPECT_EQ(fixture.error_of("def test():\n movel(" + list_text(home) + ")\nend"), "");
  EXPECT_LT((fixture.state.target.position - home).norm(), 1e-5);
}

TEST(MovelTest, UnreachableTargetIsAProtectiveStopAgainAfterEachResume)
{
  ScriptFixture fixture;
  fixture.run("def test():\n movel(p[9, 0, 0, 0, 0, 0])\n reached = True\nend");
  for (int i = 0; i < 2; ++i) {
    fixture.cycle();
    ASSERT_TRUE(fixture.protective_stop.has_value());
    EXPECT_EQ(fixture.protective_stop->code, 204);
    EXPECT_EQ(fixture.protective_stop->argument, 5);
    EXPECT_NE(fixture.stop_reason.find("out of reach"), std::string::npos) << fixture.stop_reason;
    EXPECT_EQ(fixture.machine->status(), urscript::MachineStatus::running);
    fixture.protective_stop.reset();
  }
  EXPECT_EQ(fixture.global("reached"), "");
}

TEST(MotionBuiltinsTest, InvalidArgumentsAreRunTimeErrors)
{
  ScriptFixture fixture;
  EXPECT_NE(fixture.error_of("movej(p[9, 0, 0, 0, 0, 0])").find("out of reach"), std::string::npos);
  EXPECT_NE(fixture.error_of("movej([1, 2, 3])").find("'q' must be a list of six numbers"),
            std::string::npos);
  EXPECT_NE(fixture.error_of("movej([0,0,0,0,0,0], v=-1)").find("velocity"), std::string::npos);
}

TEST(MotionBuiltinsTest, ContinuesToItsTargetAfterAProtectiveStop)
{
  ScriptFixture fixture;
  Vector6 target = fixture.state.target.position;
  target[0] += 0.5;
  fixture.run("movej(" + list_text(target) + ")");
  fixture.cycles(100);
  fixture.paused = true;
  fixture.state.safety_mode = SafetyMode::protective_stop;
  fixture.arm.stop_all(20.0);
  fixture.cycles(500);
  EXPECT_GT((fixture.state.target.position - target).norm(), 0.01);
  fixture.state.safety_mode = SafetyMode::normal;
  fixture.cycles(1);
  fixture.paused = false;
  fixture.finish();
  EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
  EXPECT_LT((fixture.state.target.position - target).norm(), 1e-6);
}

TEST(MotionBuiltinsTest, OfAKilledThreadDecelerates)
{
  ScriptFixture fixture;
  fixture.run(R"(def test():
    thread mover():
      movej([3, -1, 1, -1, 1, 0])
    end
    handle = run mover()
    sleep(0.3)
    kill handle
    sleep(2)
  end)");
  fixture.cycles(160);
  EXPECT_GT(fixture.state.target.velocity.norm(), 0.1);
  fixture.until([&] { return fixture.arm.at_rest(); }, 1.5);
}

TEST(MotionBuiltinsTest, OfAProgramThatIsStoppedDecelerates)
{
  ScriptFixture fixture;
  fixture.run("movej([3, -1, 1, -1, 1, 0])");
  fixture.cycles(150);
  const double speed = fixture.state.target.velocity.norm();
  fixture.machine->stop();
  fixture.cycle();
  EXPECT_GT(fixture.state.target.velocity.norm(), 0.5 * speed);
  fixture.until([&] { return fixture.arm.at_rest(); }, 2.0);
}

TEST(MotionBuiltinsTest, BelongsToOneThreadAtATime)
{
  ScriptFixture fixture;
  const std::string error = fixture.error_of(R"(def test():
    thread mover():
      movej([3, -1, 1, -1, 1, 0])
    end
    run mover()
    sleep(0.1)
    stopj(2)
  end)");
  EXPECT_NE(error.find("Another thread is already controlling the robot"), std::string::npos) << error;
  fixture.until([&] { return fixture.arm.at_rest(); }, 2.0);
}

TEST(MotionBuiltinsTest, CannotStartWhileTheRobotIsOff)
{
  ScriptFixture fixture;
  fixture.state.robot_mode = RobotMode::power_off;
  fixture.cycle();
  EXPECT_NE(fixture.error_of("stopj(2)").find("cannot move"), std::string::npos);
}

TEST(ServojTest, TakesItsTimeSoThatALoopNeedsNoSync)
{
  ScriptFixture fixture;
  const Vector6 start = fixture.state.target.position;
  fixture.run(
      "def test():\n i = 0\n q = " + list_text(start) +
      "\n while i < 100:\n q[5] = q[5] + 0.001\n servoj(q, t=0.002, lookahead_time=0.1, gain=300)\n i = "
      "i + 1\n end\n"
      " stopj(2)\nend");
  const double time = fixture.finish();
  EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
  EXPECT_GE(time, 0.2);
  EXPECT_GT(fixture.state.target.position[5] - start[5], 0.02);
}

TEST(SpeedlTest, MovesUntilAnotherMotionStarts)
{
  ScriptFixture fixture;
  const double start = fixture.state.target_tcp_pose[2];
  fixture.run("def test():\n speedl([0, 0, -0.05, 0, 0, 0], 0.5)\n sleep(0.5)\n stopl(1)\nend");
  fixture.finish();
  EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
  EXPECT_LT(fixture.state.target_tcp_pose[2] - start, -0.02);
  EXPECT_EQ(fixture.state.target.velocity.norm(), 0.0);
}

TEST(SpeedlTest, TurnsWithAnAccelerationOfItsOwn)
{
  ScriptFixture fixture;
  fixture.run("def test():\n speedl([0, 0, 0, 0, 0, 0.5], 0.1, t=1, aRot=5)\n stopl(0.1, aRot=5)\nend");
  const double rise = fixture.until([&] { return fixture.state.target_tcp_speed[5] > 0.499; });
  EXPECT_NEAR(rise, 0.1, 0.02);
  fixture.until([&] { return fixture.state.target_tcp_speed[5] < 0.499; });
  const double fall = fixture.until([&] { return fixture.state.target_tcp_speed[5] < 1e-3; });
  EXPECT_NEAR(fall, 0.1, 0.02);
}

TEST(SpeedjTest, LastsTheGivenTime)
{
  ScriptFixture fixture;
  const double time = [&] {
    fixture.run("speedj([0.2, 0, 0, 0, 0, 0], 1, 0.5)");
    return fixture.finish();
  }();
  EXPECT_NEAR(time, 0.5, 0.006);
}

TEST(WaypointTest, IsTheTargetOfTheActiveMove)
{
  ScriptFixture fixture;
  Vector6 pose = fixture.state.target_tcp_pose;
  const Vector6 before = pose;
  pose[0] += 0.1;
  fixture.run("def test():\n global there = p[0,0,0,0,0,0]\n thread m():\n movel(" + pose_text(pose) +
              ")\n end\n h = run m()\n sync()\n there = get_target_waypoint()\n join h\nend");
  fixture.finish();
  EXPECT_NE(urscript::Value::pose(before).text(), fixture.global("there"));
  EXPECT_EQ(urscript::Value::pose(pose).text(), fixture.global("there"));
}

TEST(RejectedBuiltinTest, FailsWithItsReason)
{
  ScriptFixture fixture;
  EXPECT_EQ(fixture.error_of("set_pos([0,0,0,0,0,0])"),
            "set_pos: only PolyScope's simulation mode places the arm");
}

struct Lapse {
  const char * name;
  const char * program;
  std::uint32_t broken_off, moves_from_motion;
};

class LapsesTest : public ::testing::TestWithParam<Lapse> {};

TEST_P(LapsesTest, AreCounted)
{
  ScriptFixture fixture;
  fixture.state.runtime_state = RuntimeState::playing;
  EXPECT_EQ(fixture.error_of(fmt::format("def test():\n{}\nend", GetParam().program)), "");
  EXPECT_EQ(fixture.state.lapses.broken_off, GetParam().broken_off);
  EXPECT_EQ(fixture.state.lapses.moves_from_motion, GetParam().moves_from_motion);
}

INSTANTIATE_TEST_SUITE_P(
    , LapsesTest,
    ::testing::Values(
        Lapse{"ended_stream", " speedj([0.5,0,0,0,0,0], 2, 0.5)\n sleep(0.5)", 1, 0},
        Lapse{"stopped_stream", " speedj([0.5,0,0,0,0,0], 2, 0.5)\n stopj(2)\n sleep(0.5)", 0, 0},
        Lapse{"killed_stream",
              " thread stream():\n  while True:\n   speedj([0.5,0,0,0,0,0], 2, 0.002)\n  end\n end\n"
              " t = run stream()\n sleep(0.5)\n kill t\n sleep(0.5)",
              1, 0},
        Lapse{"killed_and_stopped_stream",
              " thread stream():\n  while True:\n   speedj([0.5,0,0,0,0,0], 2, 0.002)\n  end\n end\n"
              " t = run stream()\n sleep(0.5)\n kill t\n stopj(2)\n sleep(0.5)",
              0, 0},
        Lapse{"move_from_motion",
              " q = get_target_joint_positions()\n speedj([0.5,0,0,0,0,0], 2, 0.5)\n movej(q, v=0.5)", 0, 1},
        Lapse{"move_from_rest",
              " q = get_target_joint_positions()\n speedj([0.5,0,0,0,0,0], 2, 0.5)\n stopj(2)\n movej(q, "
              "v=0.5)",
              0, 0},
        Lapse{"blend",
              " q = get_target_joint_positions()\n q[0] = q[0] + 0.5\n movej(q, v=0.5, r=0.05)\n q[1] = q[1] "
              "+ 0.2\n "
              "movej(q, v=0.5)",
              0, 0}),
    [](const auto & info) { return info.param.name; });

}  // namespace
}  // namespace ur_simulator
