#include <future>

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

}  // namespace
}  // namespace ur_ros_rtde::test
