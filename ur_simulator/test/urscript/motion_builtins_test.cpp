#include "common/pose.hpp"
#include "kinematics/forward.hpp"
#include "robot_rig.hpp"

namespace ur_simulator {
namespace {

using urscript::MachineStatus;

TEST(Movej, blocks_until_the_joints_are_there)
{
  RobotRig rig;
  Vector6 target = rig.state.target.position;
  target[0] += 0.5;
  rig.run("def test():\n movej(" + list_text(target) + ", a=2, v=1)\n done = True\nend");
  const double time = rig.finish();
  EXPECT_EQ(rig.machine->status(), MachineStatus::finished) << rig.machine->error().message;
  EXPECT_EQ(rig.global("done"), "True");
  EXPECT_GT(time, 0.5);
  EXPECT_LT((rig.state.target.position - target).norm(), 1e-6);
}

TEST(Movej, takes_a_pose_as_well)
{
  RobotRig rig;
  Vector6 pose = rig.state.target_tcp_pose;
  pose[2] += 0.05;
  EXPECT_EQ(rig.error_of("def test():\n movej(" + pose_text(pose) + ", t=1)\nend"), "");
  EXPECT_LT((rig.state.target_tcp_pose - pose).head<3>().norm(), 1e-6);
}

TEST(Movel, goes_straight_to_a_pose_or_to_joints)
{
  RobotRig rig;
  Vector6 pose = rig.state.target_tcp_pose;
  pose[1] += 0.1;
  EXPECT_EQ(rig.error_of("def test():\n movel(" + pose_text(pose) + ")\nend"), "");
  EXPECT_LT((rig.state.target_tcp_pose - pose).head<3>().norm(), 1e-6);
  const Vector6 home = default_position(rig.model);
  EXPECT_EQ(rig.error_of("def test():\n movel(" + list_text(home) + ")\nend"), "");
  EXPECT_LT((rig.state.target.position - home).norm(), 1e-5);
}

TEST(Movel, refuses_what_cannot_be_reached_with_a_run_time_error)
{
  RobotRig rig;
  const std::string error = rig.error_of("def test():\n movel(p[9, 0, 0, 0, 0, 0])\nend");
  EXPECT_NE(error.find("movel"), std::string::npos) << error;
  EXPECT_NE(error.find("out of reach"), std::string::npos) << error;
  EXPECT_EQ(rig.machine->error().line, 2);
  EXPECT_NE(rig.error_of("movej([1, 2, 3])").find("'q' must be a list of six numbers"), std::string::npos);
  EXPECT_NE(rig.error_of("movej([0,0,0,0,0,0], v=-1)").find("velocity"), std::string::npos);
}

TEST(Motion, goes_on_to_its_target_after_a_protective_stop)
{
  RobotRig rig;
  Vector6 target = rig.state.target.position;
  target[0] += 0.5;
  rig.run("movej(" + list_text(target) + ")");
  rig.cycles(100);
  rig.paused = true;
  rig.state.safety_mode = SafetyMode::protective_stop;
  rig.arm.halt(20.0);
  rig.cycles(500);
  EXPECT_GT((rig.state.target.position - target).norm(), 0.01);
  rig.state.safety_mode = SafetyMode::normal;
  rig.cycles(1);
  rig.paused = false;
  rig.finish();
  EXPECT_EQ(rig.machine->status(), MachineStatus::finished) << rig.machine->error().message;
  EXPECT_LT((rig.state.target.position - target).norm(), 1e-6);
}

TEST(Motion, of_a_killed_thread_decelerates)
{
  RobotRig rig;
  rig.run(R"(def test():
    thread mover():
      movej([3, -1, 1, -1, 1, 0])
    end
    handle = run mover()
    sleep(0.3)
    kill handle
    sleep(2)
  end)");
  rig.cycles(160);
  EXPECT_GT(rig.state.target.velocity.norm(), 0.1);
  rig.until([&] { return rig.arm.at_rest(); }, 1.5);
}

TEST(Motion, of_a_program_that_is_stopped_decelerates)
{
  RobotRig rig;
  rig.run("movej([3, -1, 1, -1, 1, 0])");
  rig.cycles(150);
  const double speed = rig.state.target.velocity.norm();
  rig.machine->stop();
  rig.cycle();
  EXPECT_GT(rig.state.target.velocity.norm(), 0.5 * speed);
  rig.until([&] { return rig.arm.at_rest(); }, 2.0);
}

TEST(Motion, belongs_to_one_thread_at_a_time)
{
  RobotRig rig;
  const std::string error = rig.error_of(R"(def test():
    thread mover():
      movej([3, -1, 1, -1, 1, 0])
    end
    run mover()
    sleep(0.1)
    stopj(2)
  end)");
  EXPECT_NE(error.find("Another thread is already controlling the robot"), std::string::npos) << error;
  rig.until([&] { return rig.arm.at_rest(); }, 2.0);
}

TEST(Motion, cannot_start_while_the_robot_is_off)
{
  RobotRig rig;
  rig.state.robot_mode = RobotMode::power_off;
  rig.cycle();
  EXPECT_NE(rig.error_of("stopj(2)").find("cannot move"), std::string::npos);
}

TEST(Servoj, consumes_its_time_so_that_its_loop_needs_no_sync)
{
  RobotRig rig;
  const Vector6 start = rig.state.target.position;
  rig.run("def test():\n i = 0\n q = " + list_text(start) +
          "\n while i < 100:\n q[5] = q[5] + 0.001\n servoj(q, t=0.002, lookahead_time=0.1, gain=300)\n i = "
          "i + 1\n end\n"
          " stopj(2)\nend");
  const double time = rig.finish();
  EXPECT_EQ(rig.machine->status(), MachineStatus::finished) << rig.machine->error().message;
  EXPECT_GE(time, 0.2);
  EXPECT_GT(rig.state.target.position[5] - start[5], 0.02);
}

TEST(Speedl, moves_until_something_else_follows)
{
  RobotRig rig;
  const double start = rig.state.target_tcp_pose[2];
  rig.run("def test():\n speedl([0, 0, -0.05, 0, 0, 0], 0.5)\n sleep(0.5)\n stopl(1)\nend");
  rig.finish();
  EXPECT_EQ(rig.machine->status(), MachineStatus::finished) << rig.machine->error().message;
  EXPECT_LT(rig.state.target_tcp_pose[2] - start, -0.02);
  EXPECT_EQ(rig.state.target.velocity.norm(), 0.0);
}

TEST(Speedj, lasts_the_time_that_is_given)
{
  RobotRig rig;
  const double time = [&] {
    rig.run("speedj([0.2, 0, 0, 0, 0, 0], 1, 0.5)");
    return rig.finish();
  }();
  EXPECT_NEAR(time, 0.5, 0.006);
}

TEST(Waypoint, is_the_target_of_the_move_that_runs)
{
  RobotRig rig;
  Vector6 pose = rig.state.target_tcp_pose;
  const Vector6 before = pose;
  pose[0] += 0.1;
  rig.run("def test():\n global there = p[0,0,0,0,0,0]\n thread m():\n movel(" + pose_text(pose) +
          ")\n end\n h = run m()\n sync()\n there = get_target_waypoint()\n join h\nend");
  rig.finish();
  EXPECT_NE(pose_text(before), rig.global("there"));
  EXPECT_EQ(pose_text(pose), rig.global("there"));
}

TEST(NotModelled, says_so_instead_of_pretending)
{
  RobotRig rig;
  EXPECT_EQ(rig.error_of("set_pos([0,0,0,0,0,0])"), "set_pos: not modelled by the simulator yet");
}

}  // namespace
}  // namespace ur_simulator
