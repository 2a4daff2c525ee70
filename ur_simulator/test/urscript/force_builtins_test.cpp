#include "robot_rig.hpp"

namespace ur_simulator {
namespace {

using urscript::MachineStatus;

Surface table_below(const RobotRig & rig, double distance)
{
  Surface surface;
  surface.point = rig.state.actual_tcp_pose.head<3>() - distance * Vector3::UnitZ();
  return surface;
}

const char * const press_down =
    "force_mode(p[0,0,0,0,0,0], [0,0,1,0,0,0], [0,0,-20,0,0,0], 2, [0.1,0.1,0.05,0.2,0.2,0.2])\n";

TEST(ForceModeCall, returns_at_once_and_presses_while_the_program_does_something_else)
{
  RobotRig rig;
  rig.world.place_surface(table_below(rig, 0.01));
  rig.run(std::string("def test():\n") + press_down +
          " sleep(3)\n f = get_tcp_force()\n end_force_mode()\nend");
  rig.finish();
  EXPECT_EQ(rig.machine->status(), MachineStatus::finished) << rig.machine->error().message;
  EXPECT_NEAR(rig.state.contact_wrench[2], 20.0, 1.0);
}

TEST(ForceModeCall, may_be_repeated_every_cycle)
{
  RobotRig rig;
  rig.world.place_surface(table_below(rig, 0.01));
  rig.run(std::string("def test():\n i = 0\n while i < 1500:\n  ") + press_down +
          "  sync()\n  i = i + 1\n end\nend");
  rig.finish();
  EXPECT_EQ(rig.machine->status(), MachineStatus::finished) << rig.machine->error().message;
  EXPECT_NEAR(rig.state.contact_wrench[2], 20.0, 1.0);
}

TEST(ForceModeCall, lets_a_movel_in_it_come_to_its_end)
{
  RobotRig rig;
  rig.world.place_surface(table_below(rig, 0.01));
  rig.run(std::string("def test():\n") + press_down +
          " sleep(2)\n p0 = get_actual_tcp_pose()\n movel(pose_add(p0, p[0,0.1,0,0,0,0]), v=0.1)\n"
          " end_force_mode()\nend");
  const double before = rig.state.actual_tcp_pose[1];
  EXPECT_LT(rig.finish(), 5.0);
  EXPECT_EQ(rig.machine->status(), MachineStatus::finished) << rig.machine->error().message;
  EXPECT_NEAR(rig.state.actual_tcp_pose[1] - before, 0.1, 2e-3);
}

TEST(ForceModeCall, lets_motions_end_whose_target_lies_within_the_surface)
{
  RobotRig rig;
  rig.world.place_surface(table_below(rig, 0.01));
  rig.run(std::string("def test():\n") + press_down +
          " sleep(2)\n below = pose_add(get_actual_tcp_pose(), p[0,0.1,-0.02,0,0,0])\n"
          " movel(below, v=0.1)\n movej(get_inverse_kin(pose_add(below, p[0,-0.1,0,0,0,0])), v=0.3)\nend");
  const double before = rig.state.actual_tcp_pose[1];
  rig.until([&] { return rig.state.actual_tcp_pose[1] - before > 0.099; }, 5.0);
  EXPECT_LT(rig.finish(), 2.0);
  EXPECT_EQ(rig.machine->status(), MachineStatus::finished) << rig.machine->error().message;
  EXPECT_NEAR(rig.state.actual_tcp_pose[1], before, 2e-3);
  EXPECT_NEAR(rig.state.contact_wrench[2], 20.0, 3.0);
}

// As the control script of ur_rtde does it.
TEST(ForceModeCall, may_change_the_force_under_a_motion_of_another_thread)
{
  RobotRig rig;
  rig.world.place_surface(table_below(rig, 0.01));
  rig.run(R"(def test():
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
  const double before = rig.state.actual_tcp_pose[1];
  EXPECT_LT(rig.finish(), 5.0);
  EXPECT_EQ(rig.machine->status(), MachineStatus::finished) << rig.machine->error().message;
  EXPECT_NEAR(rig.state.actual_tcp_pose[1] - before, 0.1, 2e-3);
  EXPECT_NEAR(rig.state.contact_wrench[2], 60.0, 5.0);
}

TEST(ForceModeCall, may_end_under_a_motion_which_goes_on_to_its_target)
{
  RobotRig rig;
  rig.run(R"(def test():
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
  const Vector6 before = rig.state.actual_tcp_pose;
  EXPECT_LT(rig.finish(), 5.0);
  EXPECT_EQ(rig.machine->status(), MachineStatus::finished) << rig.machine->error().message;
  EXPECT_NEAR(rig.state.target_tcp_pose[1] - before[1], 0.1, 1e-4);
  EXPECT_NEAR(rig.state.target_tcp_pose[2] - before[2], 0.01, 1e-4);
}

TEST(ForceModeCall, checks_its_arguments)
{
  RobotRig rig;
  EXPECT_NE(rig.error_of("force_mode(p[0,0,0,0,0,0], [0,0,2,0,0,0], [0,0,1,0,0,0], 2, [1,1,1,1,1,1])")
                .find("selection_vector[2] = 2"),
            std::string::npos);
  EXPECT_NE(rig.error_of("force_mode(p[0,0,0,0,0,0], [0,0,1,0,0,0], [0,0,1,0,0,0], 4, [1,1,1,1,1,1])")
                .find("type = 4"),
            std::string::npos);
  EXPECT_NE(rig.error_of("force_mode(p[0,0,0,0,0,0], [0,0,1,0,0,0], [0,0,1,0,0,0], 2, [1,1,-1,1,1,1])")
                .find("limits[2]"),
            std::string::npos);
  EXPECT_EQ(rig.error_of("force_mode_set_damping(2)"),
            "force_mode_set_damping: damping = 2 is outside of [0, 1]");
  EXPECT_EQ(rig.error_of("force_mode_set_gain_scaling(-1)"),
            "force_mode_set_gain_scaling: scaling = -1 is outside of [0, 2]");
}

TEST(ForceModeCall, is_not_for_secondary_programs)
{
  RobotRig rig;
  EXPECT_NE(rig.error_of(std::string("sec test():\n ") + press_down + "end").find("secondary program"),
            std::string::npos);
}

TEST(ScrewDriving, presses_along_the_tool)
{
  RobotRig rig;
  rig.world.place_surface(table_below(rig, 0.005));
  rig.run("def test():\n screw_driving(15, 0.05)\n sleep(3)\n end_screw_driving()\nend");
  rig.finish();
  EXPECT_EQ(rig.machine->status(), MachineStatus::finished) << rig.machine->error().message;
  EXPECT_NEAR(rig.state.contact_wrench[2], 15.0, 1.0);
}

TEST(FreedriveCall, lets_a_hand_move_the_arm_until_it_ends)
{
  RobotRig rig;
  const double before = rig.state.actual_tcp_pose[1];
  rig.run(
      "def test():\n freedrive_mode(freeAxes=[0,1,0,0,0,0], feature=\"base\")\n sleep(1)\n"
      " end_freedrive_mode()\n sleep(0.2)\nend");
  rig.cycles(5);
  EXPECT_TRUE(rig.state.freedrive);
  Push push;
  push.wrench[1] = 40.0;
  push.duration = 0.8;
  rig.world.push(push);
  rig.finish();
  EXPECT_EQ(rig.machine->status(), MachineStatus::finished) << rig.machine->error().message;
  EXPECT_FALSE(rig.state.freedrive);
  EXPECT_GT(rig.state.actual_tcp_pose[1] - before, 0.02);
}

TEST(FreedriveCall, refuses_motions_and_bad_arguments)
{
  RobotRig rig;
  EXPECT_NE(rig.error_of("def test():\n teach_mode()\n movej([0,-1,1,-1,1,0])\nend").find("freedrive"),
            std::string::npos);
  rig.arm.end_program();
  rig.cycles(100);
  EXPECT_NE(rig.error_of("freedrive_mode([0,0,3,0,0,0])").find("freeAxes[2] = 3"), std::string::npos);
  EXPECT_NE(rig.error_of("freedrive_mode([0,0,1,0,0,0], \"world\")").find("\"world\""), std::string::npos);
}

TEST(FreedriveCall, tells_how_near_a_singularity_is)
{
  RobotRig rig;
  EXPECT_EQ(rig.error_of("def test():\n s = get_freedrive_status()\n sync()\nend"), "");
  EXPECT_EQ(rig.global("s"), "0");
  Vector6 stretched = rig.state.actual.position;
  stretched[4] = 0.02;
  rig.arm.teleport(stretched, rig.state);
  EXPECT_EQ(rig.error_of("def test():\n s = get_freedrive_status()\n sync()\nend"), "");
  EXPECT_EQ(rig.global("s"), "2");
}

TEST(ToolContact, leads_back_to_where_the_tool_touched)
{
  RobotRig rig;
  const Surface table = table_below(rig, 0.03);
  rig.world.place_surface(table);
  rig.run(R"(def test():
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
  rig.finish();
  EXPECT_EQ(rig.machine->status(), MachineStatus::finished) << rig.machine->error().message;
  EXPECT_NEAR(rig.state.actual_tcp_pose[2], table.point[2], 5e-4);
}

TEST(DirectTorque, takes_a_cycle_and_moves_the_arm)
{
  RobotRig rig;
  rig.run(
      "def test():\n i = 0\n while i < 100:\n  direct_torque([30,0,0,0,0,0], viscous_scale=[1,1,1,1,1,1], "
      "coulomb_scale=[1,1,1,1,1,1])\n  i = i + 1\n end\nend");
  const double time = rig.finish();
  EXPECT_EQ(rig.machine->status(), MachineStatus::finished) << rig.machine->error().message;
  EXPECT_NEAR(time, 0.2, 0.01);
  EXPECT_GT(rig.state.actual.velocity[0], 0.1);
  EXPECT_NE(
      rig.error_of("direct_torque([0,0,0,0,0,0], viscous_scale=[2,0,0,0,0,0])").find("viscous_scale[0]"),
      std::string::npos);
}

TEST(ExternalSensor, is_switched_on_with_its_mass_and_place)
{
  RobotRig rig;
  EXPECT_EQ(rig.error_of("ft_rtde_input_enable(True, 0.3, [0,0,0.05], [0,0,0.02])"), "");
  EXPECT_TRUE(rig.state.external_sensor.enabled);
  EXPECT_EQ(rig.state.external_sensor.mass, 0.3);
  EXPECT_EQ(rig.error_of("enable_external_ft_sensor(False)"), "");
  EXPECT_FALSE(rig.state.external_sensor.enabled);
  EXPECT_NE(rig.error_of("ft_rtde_input_enable(True, -1)").find("negative"), std::string::npos);
}

}  // namespace
}  // namespace ur_simulator
