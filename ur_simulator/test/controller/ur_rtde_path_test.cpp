// What of the unmodified ur_rtde library moves along paths.
#include <ur_rtde/rtde_control_interface.h>

#include <cmath>
#include <set>

#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

using Numbers = std::vector<double>;
using ur_rtde::PathEntry;

Numbers moved(Numbers values, std::initializer_list<double> by)
{
  std::size_t i = 0;
  for (const double step : by) {
    values[i++] += step;
  }
  return values;
}

double way(const json & pose, const Numbers & to)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    sum += std::pow(pose[i].get<double>() - to[i], 2);
  }
  return std::sqrt(sum);
}

double speed(const json & state)
{
  return way(state["target_tcp_speed"], {0.0, 0.0, 0.0});
}

PathEntry entry(PathEntry::eMoveType type, const Numbers & pose, double velocity, double blend)
{
  Numbers parameters = pose;
  parameters.insert(parameters.end(), {velocity, 1.2, blend});
  return {type, PathEntry::PositionTcpPose, parameters};
}

class UrRtdePath : public SimulatorTest {
 protected:
  /// A movej, a movel and a movep round two corners, blended.
  ur_rtde::Path round_two_corners() const
  {
    ur_rtde::Path path;
    path.addEntry(entry(PathEntry::MoveJ, first, 0.8, 0.03));
    path.addEntry(entry(PathEntry::MoveL, second, 0.2, 0.03));
    path.addEntry(entry(PathEntry::MoveP, last, 0.2, 0.0));
    return path;
  }
  bool wait_for_rest()
  {
    return controller.wait_until([](const json & state) { return state["at_rest"].get<bool>(); },
                                 seconds(20));
  }

  ur_rtde::RTDEControlInterface control{controller.address(), -1.0,
                                        ur_rtde::RTDEControlInterface::FLAGS_DEFAULT, 50002, -1};
  Numbers start = controller.state()["actual_tcp_pose"].get<Numbers>();
  Numbers first = moved(start, {0.0, 0.15, 0.0});
  Numbers second = moved(first, {0.0, 0.0, -0.15});
  Numbers last = moved(second, {0.0, -0.15, 0.0});
};

TEST_F(UrRtdePath, of_mixed_motions_arrives_and_is_blended)
{
  EXPECT_TRUE(control.movePath(round_two_corners(), false));
  EXPECT_LT(way(controller.state()["actual_tcp_pose"], last), 1e-3);
  EXPECT_TRUE(control.isProgramRunning());
}

TEST_F(UrRtdePath, carried_out_asynchronously_tells_each_waypoint_as_it_turns_to_it)
{
  ASSERT_TRUE(control.movePath(round_two_corners(), true));
  std::set<int> waypoints;
  double nearest_first = 1.0, nearest_second = 1.0, slowest_between = 1.0;
  ASSERT_TRUE(controller.wait_until(
      [&](const json & state) {
        const int progress = control.getAsyncOperationProgressEx().progress();
        waypoints.insert(progress);
        nearest_first = std::min(nearest_first, way(state["target_tcp_pose"], first));
        nearest_second = std::min(nearest_second, way(state["target_tcp_pose"], second));
        if (progress == 1) {
          slowest_between = std::min(slowest_between, speed(state));
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
  EXPECT_GT(slowest_between, 0.05) << "it never stops on the way";
  EXPECT_LT(way(controller.state()["actual_tcp_pose"], last), 1e-3);
}

TEST_F(UrRtdePath, is_left_by_a_stop)
{
  ASSERT_TRUE(control.movePath(round_two_corners(), true));
  ASSERT_TRUE(controller.wait_until([](const json & state) { return speed(state) > 0.15; }, seconds(20)));
  control.stopL(2.0);
  ASSERT_TRUE(wait_for_rest());
  EXPECT_GT(way(controller.state()["actual_tcp_pose"], last), 0.05);
  EXPECT_EQ(control.getAsyncOperationProgressEx().progress(), -1);
}

TEST_F(UrRtdePath, of_lines_with_blends_is_taken_by_move_l)
{
  Numbers through = first, to = second;
  through.insert(through.end(), {0.2, 1.2, 0.03});
  to.insert(to.end(), {0.2, 1.2, 0.0});
  EXPECT_TRUE(control.moveL({through, to}));
  EXPECT_LT(way(controller.state()["actual_tcp_pose"], second), 1e-3);
}

TEST_F(UrRtdePath, of_servo_c_leads_to_its_target_and_on_to_the_next)
{
  ASSERT_TRUE(control.servoC(first, 0.2, 1.2, 0.03));
  ASSERT_TRUE(controller.wait_until(
      [&](const json & state) { return way(state["target_tcp_pose"], first) < 0.08; }, seconds(20)));
  ASSERT_TRUE(control.servoC(second, 0.2, 1.2, 0.0));
  ASSERT_TRUE(controller.wait_until(
      [&](const json & state) { return way(state["actual_tcp_pose"], second) < 1e-3; }, seconds(20)));
  control.servoStop();
  EXPECT_TRUE(wait_for_rest());
  EXPECT_TRUE(control.isProgramRunning());
}

}  // namespace
}  // namespace ur_simulator::testing
