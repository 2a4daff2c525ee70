// Path motions of the ur_rtde library.
#include <ur_rtde/rtde_control_interface.h>

#include <cmath>
#include <set>

#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

using Vector = std::vector<double>;
using ur_rtde::PathEntry;

Vector offset_by(Vector values, std::initializer_list<double> offset)
{
  std::size_t i = 0;
  for (const double step : offset) {
    values[i++] += step;
  }
  return values;
}

double distance(const json & pose, const Vector & to)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    sum += std::pow(pose[i].get<double>() - to[i], 2);
  }
  return std::sqrt(sum);
}

double tcp_speed(const json & state)
{
  return distance(state["target_tcp_speed"], {0.0, 0.0, 0.0});
}

PathEntry entry(PathEntry::eMoveType type, const Vector & pose, double velocity, double blend)
{
  Vector parameters = pose;
  parameters.insert(parameters.end(), {velocity, 1.2, blend});
  return {type, PathEntry::PositionTcpPose, parameters};
}

class UrRtdePathTest : public SimulatorTest {
 protected:
  /// A movej, a movel and a movep with two blended corners.
  ur_rtde::Path path_with_two_corners() const
  {
    ur_rtde::Path path;
    path.addEntry(entry(PathEntry::MoveJ, first, 0.8, 0.03));
    path.addEntry(entry(PathEntry::MoveL, second, 0.2, 0.03));
    path.addEntry(entry(PathEntry::MoveP, last, 0.2, 0.0));
    return path;
  }

  ur_rtde::RTDEControlInterface control{controller.address(), -1.0,
                                        ur_rtde::RTDEControlInterface::FLAGS_DEFAULT, 50002, -1};
  Vector start = controller.state()["actual_tcp_pose"].get<Vector>();
  Vector first = offset_by(start, {0.0, 0.15, 0.0});
  Vector second = offset_by(first, {0.0, 0.0, -0.15});
  Vector last = offset_by(second, {0.0, -0.15, 0.0});
};

TEST_F(UrRtdePathTest, MixedPathReachesTarget)
{
  EXPECT_TRUE(control.movePath(path_with_two_corners(), false));
  EXPECT_LT(distance(controller.state()["actual_tcp_pose"], last), 1e-3);
  EXPECT_TRUE(control.isProgramRunning());
}

TEST_F(UrRtdePathTest, AsynchronousPathReportsEachWaypoint)
{
  ASSERT_TRUE(control.movePath(path_with_two_corners(), true));
  std::set<int> waypoints;
  double nearest_first = 1.0, nearest_second = 1.0, slowest_between = 1.0;
  ASSERT_TRUE(controller.wait_until(
      [&](const json & state) {
        const int progress = control.getAsyncOperationProgressEx().progress();
        waypoints.insert(progress);
        nearest_first = std::min(nearest_first, distance(state["target_tcp_pose"], first));
        nearest_second = std::min(nearest_second, distance(state["target_tcp_pose"], second));
        if (progress == 1) {
          slowest_between = std::min(slowest_between, tcp_speed(state));
        }
        return waypoints.contains(2) && progress == -1 && state["at_rest"].get<bool>();
      },
      seconds(30)));
  waypoints.erase(-1);
  EXPECT_EQ(waypoints, (std::set<int>{0, 1, 2}));
  for (const double nearest : {nearest_first, nearest_second}) {
    EXPECT_GT(nearest, 0.003);
    EXPECT_LT(nearest, 0.03);
  }
  EXPECT_GT(slowest_between, 0.05) << "the TCP stopped between the waypoints";
  EXPECT_LT(distance(controller.state()["actual_tcp_pose"], last), 1e-3);
}

TEST_F(UrRtdePathTest, StopLInterruptsPath)
{
  ASSERT_TRUE(control.movePath(path_with_two_corners(), true));
  ASSERT_TRUE(controller.wait_until([](const json & state) { return tcp_speed(state) > 0.15; }, seconds(20)));
  control.stopL(2.0);
  ASSERT_TRUE(wait_until_at_rest(controller, seconds(20)));
  EXPECT_GT(distance(controller.state()["actual_tcp_pose"], last), 0.05);
  EXPECT_EQ(control.getAsyncOperationProgressEx().progress(), -1);
}

TEST_F(UrRtdePathTest, MoveLFollowsPathWithBlends)
{
  Vector through = first, to = second;
  through.insert(through.end(), {0.2, 1.2, 0.03});
  to.insert(to.end(), {0.2, 1.2, 0.0});
  EXPECT_TRUE(control.moveL({through, to}));
  EXPECT_LT(distance(controller.state()["actual_tcp_pose"], second), 1e-3);
}

TEST_F(UrRtdePathTest, ServoCReachesSuccessiveTargets)
{
  ASSERT_TRUE(control.servoC(first, 0.2, 1.2, 0.03));
  ASSERT_TRUE(controller.wait_until(
      [&](const json & state) { return distance(state["target_tcp_pose"], first) < 0.08; }, seconds(20)));
  ASSERT_TRUE(control.servoC(second, 0.2, 1.2, 0.0));
  ASSERT_TRUE(controller.wait_until(
      [&](const json & state) { return distance(state["actual_tcp_pose"], second) < 1e-3; }, seconds(20)));
  control.servoStop();
  EXPECT_TRUE(wait_until_at_rest(controller, seconds(20)));
  EXPECT_TRUE(control.isProgramRunning());
}

}  // namespace
}  // namespace ur_simulator::testing
