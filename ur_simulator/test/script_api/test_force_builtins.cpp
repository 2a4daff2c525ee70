#include "script_fixture.hpp"

namespace ur_simulator {
namespace {

using urscript::MachineStatus;

Surface table_below(const ScriptFixture & fixture, double distance)
{
  Surface surface;
  surface.point = fixture.state.actual_tcp_pose.head<3>() - distance * Vector3::UnitZ();
  return surface;
}

const char * const press_down =
    "force_mode(p[0,0,0,0,0,0], [0,0,1,0,0,0], [0,0,-20,0,0,0], 2, [0.1,0.1,0.05,0.2,0.2,0.2])\n";

TEST(ForceModeBuiltinTest, ReturnsAtOnceAndPressesWhileTheProgramDoesSomethingElse)
{
  ScriptFixture fixture;
  fixture.world.surfaces().add(table_below(fixture, 0.01));
  fixture.run(std::string("def test():\n") + press_down +
              " sleep(3)\n f = get_tcp_force()\n end_force_mode()\nend");
  fixture.finish();
  EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
  EXPECT_NEAR(fixture.state.contact_wrench[2], 20.0, 1.0);
}

TEST(ForceModeBuiltinTest, MayBeRepeatedEveryCycle)
{
  ScriptFixture fixture;
  fixture.world.surfaces().add(table_below(fixture, 0.01));
  fixture.run(std::string("def test():\n i = 0\n while i < 1500:\n  ") + press_down +
              "  sync()\n  i = i + 1\n end\nend");
  fixture.finish();
  EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
  EXPECT_NEAR(fixture.state.contact_wrench[2], 20.0, 1.0);
}

TEST(ForceModeBuiltinTest, AMoveLInForceModeEnds)
{
  ScriptFixture fixture;
  fixture.world.surfaces().add(table_below(fixture, 0.01));
  fixture.run(std::string("def test():\n") + press_down +
              " sleep(2)\n p0 = get_actual_tcp_pose()\n movel(pose_add(p0, p[0,0.1,0,0,0,0]), v=0.1)\n"
              " end_force_mode()\nend");
  const double before = fixture.state.actual_tcp_pose[1];
  EXPECT_LT(fixture.finish(), 5.0);
  EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
  EXPECT_NEAR(fixture.state.actual_tcp_pose[1] - before, 0.1, 2e-3);
}

TEST(ForceModeBuiltinTest, MotionsToATargetInsideTheSurfaceEnd)
{
  ScriptFixture fixture;
  fixture.world.surfaces().add(table_below(fixture, 0.01));
  fixture.run(
      std::string("def test():\n") + press_down +
      " sleep(2)\n below = pose_add(get_actual_tcp_pose(), p[0,0.1,-0.02,0,0,0])\n"
      " movel(below, v=0.1)\n movej(get_inverse_kin(pose_add(below, p[0,-0.1,0,0,0,0])), v=0.3)\nend");
  const double before = fixture.state.actual_tcp_pose[1];
  fixture.until([&] { return fixture.state.actual_tcp_pose[1] - before > 0.099; }, 5.0);
  EXPECT_LT(fixture.finish(), 2.0);
  EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
  EXPECT_NEAR(fixture.state.actual_tcp_pose[1], before, 2e-3);
  EXPECT_NEAR(fixture.state.contact_wrench[2], 20.0, 3.0);
}

// As in the control script of ur_rtde.
TEST(ForceModeBuiltinTest, ForceCanChangeDuringAMotionOfAnotherThread)
{
  ScriptFixture fixture;
  fixture.world.surfaces().add(table_below(fixture, 0.01));
  fixture.run(R"(def test():
    global wrench = [0, 0, -15, 0, 0, 0]
    global moved = False
    thread pressing():
      while True:
        force_mode(p[0,0,0,0,0,0], [0,0,1,0,0,0], wrench, 2, [0.1,0.1,0.05,0.2,0.2,0.2])
        sync()
      end
    end
    thread moving():
      movel(pose_add(get_actual_tcp_pose(), p[0,0.1,0,0,0,0]), v=0.1)
      moved = True
    end
    run pressing()
    sleep(2)
    run moving()
    sleep(0.5)
    wrench = [0, 0, -60, 0, 0, 0]
    while not moved:
      sync()
    end
  end)");
  const double before = fixture.state.actual_tcp_pose[1];
  EXPECT_LT(fixture.finish(), 5.0);
  EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
  EXPECT_NEAR(fixture.state.actual_tcp_pose[1] - before, 0.1, 2e-3);
  EXPECT_NEAR(fixture.state.contact_wrench[2], 60.0, 5.0);
}

TEST(ForceModeBuiltinTest, CanEndDuringAMotionThatContinuesToItsTarget)
{
  ScriptFixture fixture;
  fixture.run(R"(def test():
    thread moving():
      movel(target, v=0.1)
    end
    force_mode(p[0,0,0,0,0,0], [0,0,1,0,0,0], [0,0,-20,0,0,0], 2, [0.1,0.1,0.05,0.2,0.2,0.2])
    global target = pose_add(get_actual_tcp_pose(), p[0,0.1,0.01,0,0,0])
    move = run moving()
    sleep(0.5)
    end_force_mode()
    join move
  end)");
  const Vector6 before = fixture.state.actual_tcp_pose;
  EXPECT_LT(fixture.finish(), 5.0);
  EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
  EXPECT_NEAR(fixture.state.target_tcp_pose[1] - before[1], 0.1, 1e-4);
  EXPECT_NEAR(fixture.state.target_tcp_pose[2] - before[2], 0.01, 1e-4);
}

TEST(ForceModeBuiltinTest, ChecksItsArguments)
{
  ScriptFixture fixture;
  EXPECT_NE(fixture.error_of("force_mode(p[0,0,0,0,0,0], [0,0,2,0,0,0], [0,0,1,0,0,0], 2, [1,1,1,1,1,1])")
                .find("selection_vector[2] must be 0 or 1, is 2"),
            std::string::npos);
  EXPECT_NE(fixture.error_of("force_mode(p[0,0,0,0,0,0], [0,0,1,0,0,0], [0,0,1,0,0,0], 4, [1,1,1,1,1,1])")
                .find("type must be in [1, 3], is 4"),
            std::string::npos);
  EXPECT_NE(fixture.error_of("force_mode(p[0,0,0,0,0,0], [0,0,1,0,0,0], [0,0,1,0,0,0], 2, [1,1,-1,1,1,1])")
                .find("limits[2]"),
            std::string::npos);
  EXPECT_EQ(fixture.error_of("force_mode_set_damping(2)"),
            "force_mode_set_damping: damping must be in [0, 1], is 2");
  EXPECT_EQ(fixture.error_of("force_mode_set_gain_scaling(-1)"),
            "force_mode_set_gain_scaling: scaling must be in [0, 2], is -1");
}

TEST(ForceModeBuiltinTest, IsRejectedInSecondaryPrograms)
{
  ScriptFixture fixture;
  EXPECT_NE(fixture.error_of(std::string("sec test():\n ") + press_down + "end").find("secondary program"),
            std::string::npos);
}

TEST(ScrewDrivingTest, PressesAlongTheTool)
{
  ScriptFixture fixture;
  fixture.world.surfaces().add(table_below(fixture, 0.005));
  fixture.run("def test():\n screw_driving(15, 0.05)\n sleep(3)\n end_screw_driving()\nend");
  fixture.finish();
  EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
  EXPECT_NEAR(fixture.state.contact_wrench[2], 15.0, 1.0);
}

TEST(FreedriveBuiltinTest, LetsAHandMoveTheArmUntilItEnds)
{
  ScriptFixture fixture;
  const double before = fixture.state.actual_tcp_pose[1];
  fixture.run(
      "def test():\n freedrive_mode(freeAxes=[0,1,0,0,0,0], feature=\"base\")\n sleep(1)\n"
      " end_freedrive_mode()\n sleep(0.2)\nend");
  fixture.cycles(5);
  EXPECT_TRUE(fixture.state.freedrive);
  Push push;
  push.wrench[1] = 40.0;
  push.duration = 0.8;
  fixture.world.push(push);
  fixture.finish();
  EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
  EXPECT_FALSE(fixture.state.freedrive);
  EXPECT_GT(fixture.state.actual_tcp_pose[1] - before, 0.02);
}

TEST(FreedriveBuiltinTest, RejectsMotionsAndInvalidArguments)
{
  ScriptFixture fixture;
  EXPECT_NE(fixture.error_of("def test():\n teach_mode()\n movej([0,-1,1,-1,1,0])\nend").find("freedrive"),
            std::string::npos);
  fixture.arm.end_program();
  fixture.cycles(100);
  EXPECT_NE(fixture.error_of("freedrive_mode([0,0,3,0,0,0])").find("freeAxes[2] must be 0 or 1, is 3"),
            std::string::npos);
  EXPECT_NE(fixture.error_of("freedrive_mode([0,0,1,0,0,0], \"world\")").find("\"world\""),
            std::string::npos);
}

TEST(FreedriveBuiltinTest, StatusReportsTheDistanceToASingularity)
{
  ScriptFixture fixture;
  EXPECT_EQ(fixture.error_of("def test():\n s = get_freedrive_status()\n sync()\nend"), "");
  EXPECT_EQ(fixture.global("s"), "0");
  Vector6 stretched = fixture.state.actual.position;
  stretched[4] = 0.02;
  fixture.arm.teleport(stretched, fixture.state);
  EXPECT_EQ(fixture.error_of("def test():\n s = get_freedrive_status()\n sync()\nend"), "");
  EXPECT_EQ(fixture.global("s"), "2");
}

TEST(ToolContactBuiltinTest, LeadsBackToThePointOfContact)
{
  ScriptFixture fixture;
  const Surface table = table_below(fixture, 0.03);
  fixture.world.surfaces().add(table);
  fixture.run(R"(def test():
    while True:
      back = tool_contact(direction=[0, 0, -1, 0, 0, 0])
      if back <= 0:
        speedl([0, 0, -0.05, 0, 0, 0], 0.5, t=get_steptime())
      else:
        q = get_actual_joint_positions_history(back)
        stopl(3)
        movel(q)
        break
      end
    end
  end)");
  fixture.finish();
  EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
  EXPECT_NEAR(fixture.state.actual_tcp_pose[2], table.point[2], 5e-4);
}

TEST(DirectTorqueBuiltinTest, TakesACycleAndMovesTheArm)
{
  ScriptFixture fixture;
  fixture.run(
      "def test():\n i = 0\n while i < 100:\n  direct_torque([30,0,0,0,0,0], viscous_scale=[1,1,1,1,1,1], "
      "coulomb_scale=[1,1,1,1,1,1])\n  i = i + 1\n end\nend");
  const double time = fixture.finish();
  EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
  EXPECT_NEAR(time, 0.2, 0.01);
  EXPECT_GT(fixture.state.actual.velocity[0], 0.1);
  EXPECT_NE(
      fixture.error_of("direct_torque([0,0,0,0,0,0], viscous_scale=[2,0,0,0,0,0])").find("viscous_scale[0]"),
      std::string::npos);
}

TEST(ExternalSensorBuiltinTest, IsEnabledWithItsMassAndPosition)
{
  ScriptFixture fixture;
  EXPECT_EQ(fixture.error_of("ft_rtde_input_enable(True, 0.3, [0,0,0.05], [0,0,0.02])"), "");
  EXPECT_TRUE(fixture.state.external_sensor.enabled);
  EXPECT_EQ(fixture.state.external_sensor.mass, 0.3);
  EXPECT_EQ(fixture.state.external_sensor.measuring_offset.z(), 0.05);
  // "the resulting torques are computed with opposite sign" (script manual)
  EXPECT_EQ(fixture.error_of("enable_external_ft_sensor(True, 0.3, [0,0,0.05], [0,0,0.02])"), "");
  EXPECT_EQ(fixture.state.external_sensor.measuring_offset.z(), -0.05);
  EXPECT_EQ(fixture.error_of("enable_external_ft_sensor(False)"), "");
  EXPECT_FALSE(fixture.state.external_sensor.enabled);
  EXPECT_NE(fixture.error_of("ft_rtde_input_enable(True, -1)").find("negative"), std::string::npos);
}

}  // namespace
}  // namespace ur_simulator
