#pragma once

#include <cmath>

#include "robot_fixture.hpp"

namespace ur_ros_rtde::test {

/// Times are those of the simulated robot, which is slow, so that delays of a busy host are short in its
/// time.
struct LeaseTest : RobotFixture {
  void SetUp() override { make_both_slow(); }

  /// A joint motion of the holder, well under way.
  void move(const Lease & lease)
  {
    auto q = robot->receive()->getActualQ();
    q[0] += 3.0;
    ASSERT_TRUE(robot->control(lease)->moveJ(q, 0.8, 2.0, true)) << log.text();
    ASSERT_TRUE(eventually([&] { return std::abs(robot->latest()->actual_qd[0]) > 0.7; })) << log.text();
  }

  /// The arm does not move in the next 0.3 s of its time.
  testing::AssertionResult stays_at_rest()
  {
    const double end = robot->latest()->controller_time + 0.3;
    bool moved = false;
    const bool passed = eventually([&] {
      moved = moved || !at_rest();
      return robot->latest()->controller_time > end;
    });
    return passed && !moved ? testing::AssertionSuccess() : testing::AssertionFailure() << "it moves";
  }
  /// By a stop of the driver during a motion of the holder.
  void end_program(const Lease & lease)
  {
    move(lease);
    const auto call = robot->control_for_queries().hold();  // so that a stop command does not reach it
    const auto report = robot->stop_motion({}, stopped_by_the_driver());
    ASSERT_TRUE(report) << report.error().message;
    ASSERT_EQ(report->means, StopMeans::program_stopped);
  }
  void stop_and_start_program()
  {
    controller.control({{"command", "stop_program"}});
    ASSERT_TRUE(becomes_ready_again());
    ASSERT_TRUE(eventually([&] { return robot->latest()->is_program_running(); }));
    ASSERT_TRUE(eventually([&] { return at_rest(); })) << "it takes some cycles to detect it";
  }
};

}  // namespace ur_ros_rtde::test
