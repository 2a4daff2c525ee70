#include "common/pose.hpp"
#include "script_fixture.hpp"

// path_offset_…() as the script manual describes them.

namespace ur_simulator {
namespace {

using urscript::MachineStatus;

const std::string weaving = R"(
  thread weave():
    i = 0
    while True:
      i = i + 1
      path_offset_set([0, 0, 0.005 * (cos(i * 4 * 3.14159 / 500) - 1), 0, 0, 0], 1)
      sync()
    end
  end
)";

TEST(PathOffsetTest, AddsAWaveToALine)
{
  ScriptFixture fixture;
  const Vector6 from = fixture.state.target_tcp_pose;
  Vector6 to = from;
  to[1] += 0.2;
  fixture.run("def test():\n" + weaving + "  path_offset_enable()\n  h = run weave()\n  movel(" +
              pose_text(to) + ", a=1, v=0.1)\n  kill h\n  path_offset_disable()\nend");
  double lowest = 0.0, aside = 0.0, off_path = 0.0;
  fixture.until([&] {
    lowest = std::min(lowest, fixture.state.target_tcp_pose[2] - from[2]);
    aside = std::max(aside, std::abs(fixture.state.target_tcp_pose[0] - from[0]));
    if (fixture.arm.path_offset().enabled()) {
      off_path = std::max(off_path, std::abs(fixture.state.path_tcp_pose[2] - from[2]));
    }
    return fixture.machine->status() != MachineStatus::running;
  });
  EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
  EXPECT_NEAR(lowest, -0.01, 1e-4);
  EXPECT_LT(aside, 1e-6);
  EXPECT_LT(off_path, 1e-6) << "the path has no offset";
  EXPECT_NEAR(fixture.state.target_tcp_pose[1], to[1], 2e-3);
  EXPECT_FALSE(fixture.arm.take_fault());
}

TEST(PathOffsetTest, AJumpIsAFaultWithoutAFilter)
{
  for (const bool filtered : {false, true}) {
    ScriptFixture fixture;
    fixture.run(
        std::string("def test():\n  path_offset_enable()\n") +
        (filtered ? "  path_offset_set_alpha_filter(0.003)\n" : "") +
        "  path_offset_set([0, 0, -0.02, 0, 0, 0], 1)\n  sleep(5)\n  global z = path_offset_get(1)\nend");
    const double z = fixture.state.target_tcp_pose[2];
    bool fault = false;
    double reached = 0.0;
    fixture.until([&] {
      fault = fault || fixture.arm.take_fault().has_value();
      reached = std::min(reached, fixture.state.target_tcp_pose[2] - z);
      return fixture.machine->status() != MachineStatus::running;
    });
    EXPECT_EQ(fault, !filtered);
    EXPECT_NEAR(reached, filtered ? -0.02 : 0.0, 1e-3);
  }
}

/// The applied offset in base axes after a filtered offset of this type, at rest.
Vector6 offset_at_rest(const std::string & offset, int type)
{
  ScriptFixture fixture;
  fixture.run(
      "def test():\n  path_offset_enable()\n  path_offset_set_alpha_filter(0.003)\n  path_offset_set(" +
      offset + ", " + std::to_string(type) +
      ")\n  sleep(8)\n  global there = path_offset_get(1)\n  global same = path_offset_get(" +
      std::to_string(type) + ")\n  sleep(0.1)\nend");
  fixture.finish();
  EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
  EXPECT_FALSE(fixture.arm.take_fault());
  return *fixture.machine->global("there")->vector6();
}

TEST(PathOffsetTest, EachFrameHasItsAxes)
{
  const ScriptFixture fixture;
  const Transform tcp = to_transform(fixture.state.target_tcp_pose);
  const Vector3 offset(0.01, 0.02, 0.03);
  const std::string text = "[0.01, 0.02, 0.03, 0, 0, 0]";
  EXPECT_NEAR((offset_at_rest(text, 1).head<3>() - offset).norm(), 0.0, 1e-5);
  EXPECT_NEAR((offset_at_rest(text, 2).head<3>() - tcp.linear() * offset).norm(), 0.0, 1e-5);
  EXPECT_NEAR((offset_at_rest(text, 4).head<3>() + offset).norm(), 0.0, 1e-5)
      << "the base moves the other way";
  const Vector6 rotated = offset_at_rest("[0, 0, 0, 0, 0, 0.05]", 1);
  EXPECT_NEAR((rotated - (Vector6() << 0, 0, 0, 0, 0, 0.05).finished()).norm(), 0.0, 1e-5);
}

TEST(PathOffsetTest, TheMotionFrameFollowsThePath)
{
  ScriptFixture fixture;
  const Vector6 from = fixture.state.target_tcp_pose;
  const Vector3 tool_z = to_transform(from).linear().col(2);
  Vector6 to = from;
  to[1] += 0.2;
  fixture.run(
      "def test():\n  path_offset_enable()\n  path_offset_set_alpha_filter(0.01)\n  path_offset_set([0, "
      "0.01, 0, 0, 0, 0], 3)\n"
      "  movel(" +
      pose_text(to) +
      ", a=1, v=0.1)\n  global side = path_offset_get(1)\n  global own = path_offset_get(3)\nend");
  fixture.finish();
  const Vector3 expected = 0.01 * Vector3(0, 1, 0).cross(tool_z);
  EXPECT_TRUE(fixture.machine->global("side")->vector6()->head<3>().isApprox(expected, 1e-3));
  EXPECT_NEAR((*fixture.machine->global("own")->vector6())[1], 0.01, 1e-5);
}

TEST(PathOffsetTest, OffsetsAreLimited)
{
  ScriptFixture fixture;
  fixture.run(
      "def test():\n  path_offset_enable()\n  path_offset_set_alpha_filter(0.001)\n"
      "  path_offset_set([0, 0, -1, 0, 0, 0], 1)\n  sleep(20)\n  global default = path_offset_get(1)\n"
      "  path_offset_set_max_offset(0.03, 0.1)\n  path_offset_set([0, 0, -1, 0, 0, 2], 1)\n  sleep(20)\n"
      "  global own = path_offset_get(1)\nend");
  fixture.finish(60.0);
  EXPECT_NEAR((*fixture.machine->global("default")->vector6())[2], -0.1, 1e-4);
  EXPECT_NEAR((*fixture.machine->global("own")->vector6())[2], -0.03, 1e-4);
  EXPECT_NEAR((*fixture.machine->global("own")->vector6())[5], 0.1, 1e-4);
}

TEST(PathOffsetTest, WithoutTheFunctionNothingIsOffset)
{
  ScriptFixture fixture;
  const Vector6 from = fixture.state.target_tcp_pose;
  fixture.run("def test():\n  path_offset_set([0, 0, -0.05, 0, 0, 0], 1)\n  sleep(0.5)\nend");
  fixture.finish();
  EXPECT_TRUE(fixture.state.target_tcp_pose.isApprox(from, 1e-9));
}

TEST(PathOffsetTest, TheEndOfTheProgramKeepsTheArmWhereItIs)
{
  ScriptFixture fixture;
  fixture.run(
      "def test():\n  path_offset_enable()\n  path_offset_set_alpha_filter(0.003)\n"
      "  path_offset_set([0, 0, -0.02, 0, 0, 0], 1)\n  sleep(2)\nend");
  fixture.finish();
  const Vector6 there = fixture.state.target_tcp_pose;
  fixture.arm.end_program();
  fixture.cycles(500);
  EXPECT_LT((fixture.state.target_tcp_pose - there).norm(), 1e-3);
  EXPECT_TRUE(fixture.arm.at_rest());
  EXPECT_FALSE(fixture.arm.path_offset().enabled());
}

TEST(PathOffsetTest, RejectsInvalidArguments)
{
  ScriptFixture fixture;
  EXPECT_NE(fixture.error_of("def t():\n path_offset_set([0,0,0,0,0,0], 5)\nend").find("type must be 1"),
            std::string::npos);
  EXPECT_NE(fixture.error_of("def t():\n path_offset_set_alpha_filter(1.5)\nend").find("alpha must be"),
            std::string::npos);
  EXPECT_NE(fixture.error_of("def t():\n path_offset_set_max_offset(-1, 0)\nend").find("transLimit"),
            std::string::npos);
  EXPECT_NE(fixture.error_of("def t():\n path_offset_disable(0)\nend").find("a must be"), std::string::npos);
}

}  // namespace
}  // namespace ur_simulator
