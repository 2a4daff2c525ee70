#include <cmath>

#include "common/pose.hpp"
#include "robot_rig.hpp"

namespace ur_simulator {
namespace {

using urscript::MachineStatus;

Vector6 moved(Vector6 pose, double x, double y, double z)
{
  pose.head<3>() += Vector3(x, y, z);
  return pose;
}

bool said(const RobotRig & rig, const std::string & text)
{
  for (const std::string & message : rig.host.messages) {
    if (message.find(text) != std::string::npos) {
      return true;
    }
  }
  return false;
}

/// Cycle by cycle to the end of the program and the arm's rest: least distance to a point, m.
double nearest_until_rest(RobotRig & rig, const Vector6 & point)
{
  double nearest = 1e9;
  rig.until([&] {
    nearest = std::min(nearest, (rig.state.target_tcp_pose - point).head<3>().norm());
    return rig.machine->status() != MachineStatus::running && rig.arm.at_rest();
  });
  EXPECT_EQ(rig.machine->status(), MachineStatus::finished) << rig.machine->error().message;
  return nearest;
}

TEST(BlendRadius, lets_the_program_go_on_inside_of_it)
{
  RobotRig rig;
  const Vector6 to = moved(rig.state.target_tcp_pose, 0.0, 0.2, 0.0);
  rig.run("def test():\n movel(" + pose_text(to) +
          ", r=0.03)\n global there = get_target_tcp_pose()\n sleep(1)\nend");
  rig.finish();
  const auto there = rig.machine->global("there")->vector6();
  ASSERT_TRUE(there);
  EXPECT_NEAR((*there - to).head<3>().norm(), 0.03, 0.001);
  EXPECT_LT((rig.state.target_tcp_pose - to).head<3>().norm(), 1e-6) << "nothing followed";
}

TEST(BlendRadius, takes_what_the_program_decides_in_between)
{
  RobotRig rig;
  const Vector6 from = rig.state.target_tcp_pose;
  const Vector6 at = moved(from, 0.0, 0.2, 0.0), to = moved(at, 0.0, 0.0, 0.1);
  rig.run("def test():\n movej(" + pose_text(at) + ", r=0.04)\n if get_standard_digital_in(1):\n movel(" +
          pose_text(from) + ")\n else:\n movel(" + pose_text(to) + ")\n end\nend");
  const double nearest = nearest_until_rest(rig, at);
  EXPECT_GT(nearest, 0.002);
  EXPECT_LT(nearest, 0.04);
  EXPECT_LT((rig.state.target_tcp_pose - to).head<3>().norm(), 1e-6);
}

TEST(BlendRadius, that_overlaps_skips_the_waypoint_with_a_warning)
{
  RobotRig rig;
  const Vector6 from = rig.state.target_tcp_pose;
  const Vector6 at = moved(from, 0.0, 0.2, 0.0), close = moved(at, 0.05, 0.0, 0.0),
                to = moved(at, 0.0, 0.0, 0.2);
  rig.run("def test():\n movel(" + pose_text(at) + ", r=0.05)\n movel(" + pose_text(close) +
          ", r=0.02)\n movel(" + pose_text(to) + ")\nend");
  EXPECT_GT(nearest_until_rest(rig, close), 0.03);
  EXPECT_TRUE(said(rig, "Overlapping Blends: the waypoint on line 3 is skipped"));
  EXPECT_LT((rig.state.target_tcp_pose - to).head<3>().norm(), 1e-6);
}

TEST(BlendRadius, is_kept_by_a_motion_that_a_stop_interrupted)
{
  RobotRig rig;
  const Vector6 at = moved(rig.state.target_tcp_pose, 0.0, 0.3, 0.0), to = moved(at, 0.0, 0.0, 0.2);
  rig.run("def test():\n movel(" + pose_text(at) + ", r=0.04)\n movel(" + pose_text(to) + ")\nend");
  rig.cycles(300);
  rig.paused = true;
  rig.state.safety_mode = SafetyMode::protective_stop;
  rig.arm.halt(20.0);
  rig.cycles(300);
  EXPECT_TRUE(rig.arm.at_rest());
  rig.state.safety_mode = SafetyMode::normal;
  rig.cycles(1);
  rig.paused = false;
  const double nearest = nearest_until_rest(rig, at);
  EXPECT_GT(nearest, 0.005);
  EXPECT_LT(nearest, 0.04);
  EXPECT_LT((rig.state.target_tcp_pose - to).head<3>().norm(), 1e-6);
}

TEST(Movep, passes_its_waypoints_at_one_speed)
{
  RobotRig rig;
  const Vector6 from = rig.state.target_tcp_pose;
  const Vector6 at = moved(from, 0.0, 0.2, 0.0), to = moved(at, 0.0, 0.0, 0.2);
  rig.run("def test():\n movep(" + pose_text(at) + ", v=0.2, r=0.05)\n movep(" + pose_text(to) +
          ", v=0.2)\nend");
  rig.until([&] { return (rig.state.target_tcp_pose - from).head<3>().norm() > 0.1; });
  double slowest = 1.0;
  rig.until([&] {
    slowest = std::min(slowest, rig.state.target_tcp_speed.head<3>().norm());
    return rig.state.target_tcp_pose[2] - from[2] > 0.1;
  });
  EXPECT_GT(slowest, 0.198);
  rig.finish();
  EXPECT_LT((rig.state.target_tcp_pose - to).head<3>().norm(), 1e-6);
}

TEST(Movep, and_the_others_take_joint_positions_as_well)
{
  RobotRig rig;
  Vector6 joints = rig.state.target.position;
  joints[0] += 0.2;
  const Vector6 home = rig.state.target.position;
  EXPECT_EQ(rig.error_of("movep(" + list_text(joints) + ")"), "");
  EXPECT_LT((rig.state.target.position - joints).norm(), 1e-5);
  EXPECT_EQ(rig.error_of("optimovel(" + list_text(home) + ")"), "");
  EXPECT_LT((rig.state.target.position - home).norm(), 1e-5);
  EXPECT_EQ(rig.error_of("optimovej(" + list_text(joints) + ", a=0.5, v=0.5)"), "");
  EXPECT_EQ(rig.state.target.position, joints);
}

TEST(Movec, goes_on_along_its_circle_after_a_protective_stop)
{
  for (const int mode : {0, 1}) {
    RobotRig rig;
    const Vector6 from = rig.state.target_tcp_pose;
    const Vector3 centre = moved(from, -0.15, 0.0, 0.0).head<3>();
    const auto on_circle = [&](double angle) {
      Vector6 pose = from;
      pose.head<3>() = centre + 0.15 * Vector3(std::cos(angle), std::sin(angle), 0.0);
      return pose;
    };
    rig.run("movec(" + pose_text(on_circle(0.5)) + ", " + pose_text(on_circle(1.5)) +
            ", v=0.15, mode=" + std::to_string(mode) + ")");
    rig.until([&] { return (rig.state.target_tcp_pose - on_circle(1.0)).head<3>().norm() < 0.01; });
    rig.paused = true;
    rig.state.safety_mode = SafetyMode::protective_stop;
    rig.arm.halt(20.0);
    rig.cycles(300);
    rig.state.safety_mode = SafetyMode::normal;
    rig.cycles(1);
    rig.paused = false;
    double farthest = 0.0;
    rig.until([&] {
      const double off = (rig.state.target_tcp_pose.head<3>() - centre).norm() - 0.15;
      farthest = std::max(farthest, std::abs(off));
      return rig.machine->status() != MachineStatus::running;
    });
    EXPECT_EQ(rig.machine->status(), MachineStatus::finished) << rig.machine->error().message;
    EXPECT_LT(farthest, 2e-3) << mode;
    EXPECT_LT((rig.state.target_tcp_pose - on_circle(1.5)).head<3>().norm(), 1e-6) << mode;
    const Eigen::Matrix3d turned =
        to_rotation(rig.state.target_tcp_pose.tail<3>()) * to_rotation(from.tail<3>()).transpose();
    EXPECT_NEAR(to_rotation_vector(turned).norm(), mode == 1 ? 1.5 : 0.0, 1e-5);
  }
}

TEST(Servoc, in_a_loop_reaches_its_target_and_stays_there)
{
  RobotRig rig;
  const Vector6 to = moved(rig.state.target_tcp_pose, 0.0, 0.1, 0.05);
  rig.run("def test():\n thread servo():\n while True:\n servoc(" + pose_text(to) +
          ", a=1, v=0.2, r=0.01)\n end\n end\n h = run servo()\n sleep(2)\n kill h\n stopl(2)\nend");
  rig.finish();
  EXPECT_EQ(rig.machine->status(), MachineStatus::finished) << rig.machine->error().message;
  EXPECT_LT((rig.state.target_tcp_pose - to).head<3>().norm(), 1e-6);
}

TEST(PathCalls, end_the_program_when_their_arguments_are_bad)
{
  RobotRig rig;
  const Vector6 from = rig.state.target_tcp_pose;
  const std::string to = pose_text(moved(from, 0.0, 0.1, 0.0));
  const std::string via = pose_text(moved(from, 0.0, 0.05, 0.0));
  const std::string beside = pose_text(moved(from, 0.0, 0.05, 0.05));
  const auto error = [&](const std::string & text) { return rig.error_of(text); };
  EXPECT_EQ(error("movep(" + to + ", v=0)"), "movep: velocity must be greater than 0, is 0");
  EXPECT_EQ(error("movep(" + to + ", a=-1)"), "movep: acceleration must be greater than 0, is -1");
  EXPECT_NE(error("movep(" + to + ", r=-0.1)").find("movep: blend radius must be in [0, "),
            std::string::npos);
  EXPECT_NE(error("movej(" + list_text(rig.state.target.position) + ", r=-0.1)").find("blend radius"),
            std::string::npos);
  EXPECT_NE(error("servoc(" + to + ", v=0)").find("servoc: velocity"), std::string::npos);
  EXPECT_NE(error("servoc(p[9, 0, 0, 0, 0, 0])").find("servoc: "), std::string::npos);
  EXPECT_NE(error("movec(" + via + ", " + to + ")").find("must not lie on one line"), std::string::npos);
  EXPECT_EQ(error("movec(" + beside + ", " + to + ", mode=2)"),
            "movec: mode = 2 is neither 0 (unconstrained) nor 1 (fixed)");
  EXPECT_NE(error("movec([1, 2], " + to + ")").find("'pose_via' must be"), std::string::npos);
  EXPECT_EQ(error("optimovej(" + list_text(rig.state.target.position) + ", a=1.4)"),
            "optimovej: a must be in (0, 1], is 1.4");
  const std::string infinite = error("movep([0, 1e308 * 1e308, 0, 0, 0, 0])");
  EXPECT_NE(infinite.find("'pose' must be"), std::string::npos) << infinite;
  EXPECT_TRUE(rig.arm.at_rest());
}

}  // namespace
}  // namespace ur_simulator
