#include "script_fixture.hpp"

namespace ur_simulator {
namespace {

TEST(WorldModelTest, FramesFollowTheFrameTheyAreAttachedTo)
{
  ScriptFixture fixture;
  EXPECT_EQ(fixture.error_of(R"(def test():
    reset_world_model()
    add_frame("table", p[1, 0, 0, 0, 0, d2r(90)])
    add_frame("part", p[0.5, 0, 0, 0, 0, 0], "table")
    attach_frame("part", "table")
    a = get_pose("part", "base")
    move_frame("table", p[2, 0, 0, 0, 0, 0])
    b = get_pose("part", "world")
    c = [get_frame_parent("part"), get_children("table"), is_frame("tool")]
    delete_frame("table")
    d = [get_frame_parent("part"), is_frame("table")]
    x = point_dist(a, p[1, 0.5, 0, 0, 0, 0]) < 0.000001 and pose_dist(b, p[2.5, 0, 0, 0, 0, 0]) < 0.000001
  end)"),
            "");
  EXPECT_EQ(fixture.global("x"), "True") << fixture.global("a") << fixture.global("b");
  EXPECT_EQ(fixture.global("c"), "[\"table\", [\"part\"], False]");
  EXPECT_EQ(fixture.global("d"), "[\"world\", False]");
}

TEST(WorldModelTest, PosesAreConvertedBetweenFrames)
{
  ScriptFixture fixture;
  EXPECT_EQ(fixture.error_of(R"(def test():
    add_frame("table", p[1, 0, 0, 0, 0, d2r(90)])
    a = convert_pose(p[0, 1, 0, 0, 0, 0], "base", "table")
    b = pose_trans(get_actual_tcp_pose(), p[0, 0, 0.1, 0, 0, 0])
    c = convert_pose(p[0, 0, 0.1, 0, 0, 0], "tcp", "base")
    e = get_pose("base", "table", "base")
    x = [point_dist(a, p[1, 1, 0, 0, 0, 0]) < 0.000001, point_dist(b, c) < 0.000001]
    y = point_dist(e, p[-1, 0, 0, 0, 0, 0]) < 0.000001
    z = pose_dist(get_pose("table"), get_pose("table", "base"))
  end)"),
            "");
  EXPECT_EQ(fixture.global("x"), "[True, True]") << fixture.global("a") << fixture.global("c");
  EXPECT_EQ(fixture.global("y"), "True") << fixture.global("e");
  EXPECT_EQ(fixture.global("z"), "0");
}

// UR, "World Model API": the base may be moved and attached, the arm moves with it.
TEST(WorldModelTest, ArmFollowsBaseUntilReset)
{
  ScriptFixture fixture;
  EXPECT_EQ(fixture.error_of(R"(def test():
    move_frame("base", p[1, 2, 0, 0, 0, 0], "world")
    a = pose_dist(get_pose("base", "world"), p[1, 2, 0, 0, 0, 0]) < 0.000001
    b = point_dist(get_pose("tcp", "world"), pose_trans(p[1, 2, 0, 0, 0, 0], get_actual_tcp_pose())) < 0.000001
    add_frame("rail", p[0, 0, 1, 0, 0, 0], "world")
    attach_frame("base", "rail")
    move_frame("rail", p[0, 0, 2, 0, 0, 0], "world")
    c = pose_dist(get_pose("base", "world"), p[1, 2, 1, 0, 0, 0]) < 0.000001
    reset_world_model()
    x = [a, b, c, pose_dist(get_pose("base", "world"), p[0, 0, 0, 0, 0, 0])]
  end)"),
            "");
  EXPECT_EQ(fixture.global("x"), "[True, True, True, 0]");
  EXPECT_EQ(fixture.error_of("delete_frame(\"base\")"), "delete_frame: the frame 'base' cannot be deleted");
  EXPECT_EQ(fixture.error_of(R"(def test():
    add_frame("a", p[0, 0, 0, 0, 0, 0])
    attach_frame("a", "tcp")
    attach_frame("base", "a")
  end)"),
            "attach_frame: the frame 'a' is attached to 'base' already");
}

TEST(WorldModelTest, RejectsUnknownFixedAndCyclicFrames)
{
  ScriptFixture fixture;
  EXPECT_EQ(fixture.error_of("get_pose(\"x\", \"base\")"), "get_pose: the world model has no frame 'x'");
  EXPECT_EQ(fixture.error_of("move_frame(\"tcp\", p[0, 0, 0, 0, 0, 0])"),
            "move_frame: the frame 'tcp' is fixed");
  EXPECT_EQ(fixture.error_of(R"(def test():
    add_frame("a", p[0, 0, 0, 0, 0, 0])
    add_frame("b", p[0, 0, 0, 0, 0, 0])
    attach_frame("a", "b")
    attach_frame("b", "a")
  end)"),
            "attach_frame: the frame 'a' is attached to 'b' already");
  EXPECT_EQ(fixture.error_of("add_frame(\"a\", p[0, 0, 0, 0, 0, 0])"),
            "add_frame: the world model has a frame 'a' already, or the name is empty");
}

}  // namespace
}  // namespace ur_simulator
