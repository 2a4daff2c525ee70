// A stream of setpoints that has to brake without a stop along its path, and one that is late. Times are
// those of the simulated robot.
#include <algorithm>
#include <cmath>

#include "stream_fixture.hpp"
#include "streaming/servo_setpoint.hpp"
#include "streaming/servo_stream.hpp"
#include "ur_ros_rtde_trajectory/plan.hpp"

namespace ur_ros_rtde::test {
namespace {

using trajectory::Joints;
using trajectory::Limits;
using trajectory::Trajectory;

/// A setpoint: s of the plan, and of the controller's clock; rad of joint 0.
struct Step {
  double time, controller_time, position;
};

struct ServoStreamTest : StreamFixture {
  static Limits limits(double velocity, double acceleration)
  {
    Limits result;
    result.velocity.setConstant(velocity);
    result.acceleration.setConstant(acceleration);
    result.jerk.setConstant(20.0);
    return result;
  }
  /// A motion of joint 0 that begins where the arm is.
  Trajectory plan(double distance, const Limits & bounds) const
  {
    const Joints start = Eigen::Map<const Joints>(robot.latest()->target_q.data());
    Joints end = start;
    end[0] += distance;
    return *trajectory::plan_path(std::vector<Joints>{start, end}, bounds);
  }
  void add(const StreamState & state)
  {
    const Joints setpoint = servo_setpoint(state.desired, ServoParameters{}, Limits{});
    steps.push_back({state.time, state.sample.controller_time, setpoint[0]});
  }
  /// The longest time between two setpoints, from this one on.
  double longest_gap(std::size_t first) const
  {
    double longest = 0.0;
    for (std::size_t i = first + 1; i < steps.size(); ++i) {
      longest = std::max(longest, steps[i].controller_time - steps[i - 1].controller_time);
    }
    return longest;
  }

  std::vector<Step> steps;
};

TEST_F(ServoStreamTest, SlowsDownAlongItsPathIfNoStopIsFoundInTime)
{
  const Trajectory planned = plan(3.0, limits(0.2, 1.0));
  // The plan is faster, so that no stop keeps them: the search ends with its time.
  const Limits too_slow = limits(0.1, 0.2);
  std::size_t request = 0;  // number of the last setpoint before the stop
  ServoStream stream(*run, ServoSettings{}, [&](const Trajectory & streamed, const StreamState & state) {
    EXPECT_EQ(streamed.duration(), planned.duration()) << "it follows a stop instead of the plan";
    if (state.time > 0.5 && stop_request->request(Error{ErrorCode::canceled, "canceled"})) {
      request = steps.size();
    }
    add(state);
    return Status();
  });
  const Outcome outcome = stream.execute(planned, too_slow);
  EXPECT_EQ(outcome.code(), ErrorCode::canceled) << outcome.message();
  EXPECT_TRUE(run->may_brake()) << "a stop has taken the arm";
  ASSERT_GT(steps.size(), request + 1) << "it has not braked";
  EXPECT_LT(steps.back().time - steps[request].time, 0.65)
      << "0.2 rad/s at 0.2 rad/s^2 take 1 s, 0.5 s of the plan";
  if (longest_gap(request) <=
      SetpointClock::bridged_cycles * robot.cycle_time()) {  // it slows down more if it is late
    EXPECT_GT(steps.back().controller_time - steps[request].controller_time, 0.9)
        << "it brakes harder than its limits";
  }
  EXPECT_TRUE(eventually([&] { return !robot.is_moving(); }));
  EXPECT_NEAR(robot.latest()->actual_q[0], planned.sample(steps.back().time).position[0], 0.005);
  EXPECT_TRUE(robot.end_motion(lease, {}));
}

TEST_F(ServoStreamTest, SlowsDownAfterALateSetpointWithoutAJump)
{
  constexpr double delay = 0.1;  // s
  const Limits bounds = limits(0.3, 1.0);
  const Trajectory planned = plan(0.5, bounds);
  std::size_t late = 0;  // number of the late setpoint
  ServoStream stream(*run, ServoSettings{}, [&](const Trajectory &, const StreamState & state) {
    add(state);
    if (state.time > 0.7 && late == 0) {
      late = steps.size();
      Sample now = state.sample;
      EXPECT_TRUE(eventually([&] {
        static_cast<void>(robot.wait_for_next(now, 100ms));
        return now.controller_time > state.sample.controller_time + delay;
      }));
    }
    return Status();
  });
  const Outcome outcome = stream.execute(planned, bounds);
  EXPECT_TRUE(outcome) << outcome.message();
  ASSERT_GT(late, 0U);
  ASSERT_GT(steps.size(), late + 1);
  EXPECT_GT(steps[late].controller_time - steps[late - 1].controller_time, delay);
  for (std::size_t i = 1; i < steps.size(); ++i) {
    EXPECT_LE(steps[i].time - steps[i - 1].time,
              steps[i].controller_time - steps[i - 1].controller_time + 1e-9)
        << "it catches up at " << steps[i].time << " s";
  }
  EXPECT_NEAR(steps[late].position, steps[late - 1].position, 0.1 * delay * bounds.velocity[0])
      << "the arm would follow it with a jerk";
  const Step &first = steps[late], &second = steps[late + 1];
  EXPECT_LT(second.time - first.time, 0.7 * (second.controller_time - first.controller_time))
      << "it goes on as fast as before";
  EXPECT_EQ(steps.back().time, planned.duration());
  EXPECT_TRUE(eventually([&] { return !robot.is_moving(); }));
  EXPECT_NEAR(robot.latest()->actual_q[0], planned.sample(planned.duration()).position[0], 0.005);
  EXPECT_TRUE(robot.end_motion(lease, {}));
}

}  // namespace
}  // namespace ur_ros_rtde::test
