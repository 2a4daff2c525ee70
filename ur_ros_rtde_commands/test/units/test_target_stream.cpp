#include <algorithm>
#include <future>
#include <limits>

#include "stream_fixture.hpp"
#include "ur_ros_rtde/streaming.hpp"

namespace ur_ros_rtde::test {
namespace {

struct TargetStreamTest : StreamFixture {};

TEST_F(TargetStreamTest, EndsWithItsTimeoutIfAnotherThreadKeepsTheInterface)
{
  StreamOptions options;
  options.timeout = 0.5;
  std::promise<void> end;
  std::future<void> other;
  const auto stream_twists = [&]() -> Status {
    TargetStream stream(*run, follow_twists(options), options);
    while (true) {
      if (auto why = stream.wait()) {
        return tl::unexpected(*why);
      }
      if (Status valid = stream.set({{0.0, 0.05, 0.0, 0.0, 0.0, 0.0}}); !valid) {
        return valid;
      }
      if (!other.valid() && robot.is_moving()) {
        std::promise<void> keeps;
        other = std::async(std::launch::async, [&] {
          const auto held = robot.control_for_queries().hold();
          keeps.set_value();
          end.get_future().wait_for(10s);
        });
        keeps.get_future().wait();
      }
      if (Status sent = stream.send(); !sent) {
        return sent;
      }
    }
  };
  const auto stream = [&]() -> Status {
    try {
      return stream_twists();
    } catch (const RobotError & error) {
      return tl::unexpected(error.error());
    }
  };
  auto streamed = std::async(std::launch::async, stream);
  EXPECT_EQ(streamed.wait_for(4s), std::future_status::ready) << "the last twist goes on";
  EXPECT_TRUE(robot.end_motion(lease, {})) << "by other means than the interface";
  EXPECT_TRUE(eventually([&] { return !robot.is_moving(); }));
  end.set_value();
  other.get();
  EXPECT_EQ(streamed.get().error().code, ErrorCode::busy);
}

TEST_F(TargetStreamTest, RejectsTwistsThatAreTooFastOrNoNumbers)
{
  TargetStream stream(*run, follow_twists({}), {});
  for (const double value : {5.0, std::numeric_limits<double>::quiet_NaN()}) {
    for (const std::size_t axis : {1U, 4U}) {
      StreamTarget target;
      target.values[axis] = value;
      const Status valid = stream.set(target);
      ASSERT_FALSE(valid);
      EXPECT_EQ(valid.error().code, ErrorCode::invalid_goal);
    }
  }
  EXPECT_TRUE(stream.set({}));
}

/// The control program bridges the gap by extrapolation; the setpoints after it must not stay behind that.
TEST_F(TargetStreamTest, JointsDoNotPassATargetAtRestAfterAGap)
{
  StreamOptions options;
  options.timeout = 5.0;
  TargetStream stream(*run, follow_joints(options), options);
  const double cycle = robot.cycle_time();
  StreamTarget target;
  target.values = run->state().actual_q;
  const double end = target.values[0] + 0.3;
  double highest = target.values[0];
  const auto passes_a_cycle = [&] {
    ASSERT_FALSE(stream.wait());
    target.values[0] = std::min(target.values[0] + 0.8 * cycle, end);
    ASSERT_TRUE(stream.set(target, cycle));
    ASSERT_TRUE(stream.send());
    highest = std::max(highest, robot.latest()->target_q[0]);
  };
  while (target.values[0] < end && !HasFatalFailure()) {
    if (end - target.values[0] < 4.0 * cycle) {  // until then, it extrapolates at full speed
      const double until = robot.latest()->controller_time + 5.0 * cycle;
      ASSERT_TRUE(eventually([&] { return robot.latest()->controller_time >= until; }));
    }
    passes_a_cycle();
  }
  for (int i = 0; i < 50 && !HasFatalFailure(); ++i) {
    passes_a_cycle();
  }
  EXPECT_LT(highest, end + 0.8 * cycle);
}

}  // namespace
}  // namespace ur_ros_rtde::test
