#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde::test {
namespace {

using std::chrono::nanoseconds;

/// A run without a controller.
struct RunTest : testing::Test {
  Robot robot{[] {
    RobotOptions options;
    options.address = "127.0.0.1";
    return options;
  }()};
  std::shared_ptr<StopRequest> stop_request = std::make_shared<StopRequest>();
  ur_ros_rtde::Run run{RunContext{robot, stop_request}};
};

TEST_F(RunTest, ATimeoutMayBeAsLongAsADurationCanBe)
{
  int evaluations = 0;
  EXPECT_FALSE(run.until([&] { return ++evaluations == 3; }, nanoseconds::max()));
  EXPECT_EQ(evaluations, 3);
}

TEST_F(RunTest, ATimeoutMayBeInThePast)
{
  const auto why = run.until([] { return false; }, nanoseconds::min());
  ASSERT_TRUE(why);
  EXPECT_EQ(why->code, ErrorCode::timeout);
}

TEST_F(RunTest, BrakesNothingWithoutTheArm)
{
  EXPECT_FALSE(run.may_brake());
  EXPECT_THROW(run.brake_by_itself(), RobotError);
  Lease not_granted;
  const ur_ros_rtde::Run without_lease{RunContext{robot, stop_request, &not_granted}};
  EXPECT_FALSE(without_lease.may_brake());
  EXPECT_THROW(without_lease.brake_by_itself(), RobotError);
}

TEST_F(RunTest, TheTimeoutOfAnExtensionIsChecked)
{
  using Limits = std::numeric_limits<double>;
  for (const double timeout : {Limits::quiet_NaN(), Limits::infinity(), -1.0, 0.0, 1e9}) {
    EXPECT_EQ(run.trigger(timeout).code(), ErrorCode::invalid_goal) << timeout;
  }
}

}  // namespace
}  // namespace ur_ros_rtde::test
