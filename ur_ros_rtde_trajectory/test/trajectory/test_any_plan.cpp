// Each goal that the action accepts has a motion within its limits.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <ctime>
#include <future>
#include <string>

#include "random_paths.hpp"
#include "ur_ros_rtde_trajectory/arm_limits.hpp"

namespace ur_ros_rtde::trajectory::test {
namespace {

void expect_motion(unsigned long seed)
{
  const RandomPlan wanted = extreme_plan(seed);
  const auto plan = plan_path(wanted.waypoints, wanted.limits, wanted.options);
  ASSERT_TRUE(plan) << "seed " << seed << ": " << plan.error().message;
  EXPECT_TRUE(std::isfinite(plan->duration())) << "seed " << seed;
  const auto verified = plan->verify(wanted.limits);
  EXPECT_TRUE(verified) << "seed " << seed << ": " << verified.error().message;
}

// UR_PLANS: how many.
TEST(AnyPlanTest, HasAMotionWithinItsLimits)
{
  const char * given = std::getenv("UR_PLANS");
  const unsigned long count = given != nullptr ? std::stoul(given) : 80;
  for (unsigned long seed = 100; seed < 100 + count; ++seed) {
    expect_motion(seed);
  }
}

// The solver diverges in each of these.
TEST(AnyPlanTest, HasAMotionIfTheSolverDiverges)
{
  for (const unsigned long seed :
       {249UL, 362UL, 643UL, 888UL, 901UL, 905UL, 1049UL, 1152UL, 1254UL, 1480UL}) {
    expect_motion(seed);
  }
}

TEST(AnyPlanTest, HasAMotionThroughCornersWithTinyBlends)
{
  Limits limits = default_speed_limits(make_limits(arm_limits("ur10e").value()));
  limits.acceleration.setConstant(40.0);
  const std::vector<std::vector<double>> waypoints{{0.8352, 1.3993, 1.2463, -0.5159, 0.509, 2.6061},
                                                   {0.8352, 1.4993, 1.2465, -0.5157, 0.759, 2.6064},
                                                   {0.8852, 1.5993, 1.3965, -0.3157, 1.009, 2.9064},
                                                   {0.8853, 1.6993, 1.5465, -0.1157, 1.0093, 3.2064}};
  PathOptions options;
  options.blend_tolerance = 1e-6;
  const auto plan = plan_path(waypoints, limits, options);
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_TRUE(plan->verify(limits));
  EXPECT_LT(plan->duration(), 3.0);
}

TEST(AnyPlanTest, IsCanceledWithinASegment)
{
  std::vector<Joints> waypoints;  // of one segment
  for (std::size_t i = 0; i < max_waypoints; ++i) {
    const double angle = 0.001 * static_cast<double>(i);
    waypoints.push_back({std::sin(angle), std::cos(1.3 * angle), 0.0, 0.0, 0.0, 0.0});
  }
  const Limits limits = make_limits(arm_limits("ur10e").value());
  PathOptions options;
  std::stop_source stop;
  options.stop = stop.get_token();
  auto plan = std::async(std::launch::async, [&] { return plan_path(waypoints, limits, options); });
  ASSERT_EQ(plan.wait_for(std::chrono::milliseconds(100)), std::future_status::timeout);
  const std::clock_t begin = std::clock();
  stop.request_stop();
  const auto result = plan.get();
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::canceled);
  EXPECT_LT(std::clock() - begin, CLOCKS_PER_SEC) << "of this process: other load does not count";
}

}  // namespace
}  // namespace ur_ros_rtde::trajectory::test
