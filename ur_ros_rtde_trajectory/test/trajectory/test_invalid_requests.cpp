#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "checks.hpp"
#include "ur_ros_rtde_trajectory/plan.hpp"
#include "ur_ros_rtde_trajectory/sampled.hpp"

namespace ur_ros_rtde::trajectory::test {
namespace {

struct Request {
  std::vector<std::vector<double>> waypoints{
      std::vector<double>(6, 0.0), std::vector<double>(6, 0.5), {0.1, -0.2, 0.3, -0.4, 0.5, -0.6}};
  Limits limits;
  PathOptions options;

  Request()
  {
    limits.position_min.setConstant(-6.3);
    limits.position_max.setConstant(6.3);
    limits.velocity.setConstant(3.0);
    limits.acceleration.setConstant(5.0);
    limits.jerk.setConstant(50.0);
  }
  Expected<Trajectory> plan() const { return plan_path(waypoints, limits, options); }
};

struct InvalidRequest {
  const char * name;
  void (*modify)(Request &);
  const char * message_part;
};

class InvalidRequestTest : public testing::TestWithParam<InvalidRequest> {};

TEST_P(InvalidRequestTest, IsRejectedWithFieldValueAndLimit)
{
  Request request;
  ASSERT_TRUE(request.plan());
  GetParam().modify(request);
  const auto plan = request.plan();
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, ErrorCode::invalid_goal);
  EXPECT_NE(plan.error().message.find(GetParam().message_part), std::string::npos) << plan.error().message;
}

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    Each, InvalidRequestTest,
    testing::Values(
        InvalidRequest{"NoWaypoint", [](Request & r) { r.waypoints.clear(); }, "waypoints is empty"},
        InvalidRequest{"TooManyWaypoints", [](Request & r) { r.waypoints.resize(10001, r.waypoints[0]); },
                       "has 10001 entries"},
        InvalidRequest{"FiveJoints", [](Request & r) { r.waypoints[1].pop_back(); },
                       "waypoint 1 has 5 values"},
        InvalidRequest{"NoJoints", [](Request & r) { r.waypoints[2].clear(); }, "waypoint 2 has 0 values"},
        InvalidRequest{"SevenJoints", [](Request & r) { r.waypoints[0].push_back(0.0); },
                       "waypoint 0 has 7 values"},
        InvalidRequest{"PositionNan", [](Request & r) { r.waypoints[1][2] = not_a_number; },
                       "waypoint 1 of elbow_joint is nan"},
        InvalidRequest{"PositionInfinite", [](Request & r) { r.waypoints[1][2] = -INFINITY; },
                       "elbow_joint is -inf"},
        InvalidRequest{
            "position_beyond_limit", [](Request & r) { r.waypoints[2][4] = 6.5; },
            "waypoint 2: position of wrist_2_joint is 6.5 rad, outside its limits -6.3 to 6.3 rad"},
        InvalidRequest{"VelocityLimitZero", [](Request & r) { r.limits.velocity[1] = 0.0; },
                       "velocity limit of shoulder_lift_joint is 0"},
        InvalidRequest{"VelocityLimitInfinite", [](Request & r) { r.limits.velocity[1] = INFINITY; },
                       "velocity limit"},
        InvalidRequest{"AccelerationLimitNegative", [](Request & r) { r.limits.acceleration[0] = -1.0; },
                       "acceleration limit of shoulder_pan_joint is -1"},
        InvalidRequest{"JerkLimitNan", [](Request & r) { r.limits.jerk[5] = not_a_number; },
                       "jerk limit of wrist_3_joint is nan"},
        InvalidRequest{"JerkLimitZero", [](Request & r) { r.limits.jerk[5] = 0.0; },
                       "jerk limit of wrist_3_joint is 0"},
        InvalidRequest{"PositionLimitsCrossed", [](Request & r) { r.limits.position_min[3] = 7.0; },
                       "position limits of wrist_1_joint"},
        InvalidRequest{"ToleranceNegative", [](Request & r) { r.options.blend_tolerance = -0.1; },
                       "blend_tolerance is -0.1"},
        InvalidRequest{"ToleranceNan", [](Request & r) { r.options.blend_tolerance = not_a_number; },
                       "blend_tolerance is nan"},
        InvalidRequest{"CornerAngleTooLarge", [](Request & r) { r.options.corner_angle = 4.0; },
                       "corner_angle is 4"},
        InvalidRequest{"SpeedZero", [](Request & r) { r.options.speed_fraction = 0.0; },
                       "speed_fraction is 0"},
        InvalidRequest{"SpeedAboveOne", [](Request & r) { r.options.speed_fraction = 1.5; },
                       "speed_fraction is 1.5"}),
    [](const auto & bad) { return bad.param.name; });

TEST(InvalidJointsTest, AreRejected)
{
  const std::vector<Joints> waypoints{Joints::Zero(), Joints::Constant(not_a_number)};
  const auto plan = plan_path(waypoints, Request().limits);
  ASSERT_FALSE(plan);
  EXPECT_NE(plan.error().message.find("waypoint 1: position of shoulder_pan_joint is nan"), std::string::npos)
      << plan.error().message;
}

struct InvalidSegment {
  const char * name;
  void (*modify)(std::vector<SampledSegment> &);
  const char * message_part;
};

class InvalidSegmentTest : public testing::TestWithParam<InvalidSegment> {};

TEST_P(InvalidSegmentTest, IsRejectedWithItsNumber)
{
  std::vector<SampledSegment> segments{
      {{0.0, 0.5, 1.0}, {Joints::Zero(), Joints::Constant(0.1), Joints::Constant(0.2)}, {0.1, 0.1}}};
  ASSERT_TRUE(plan_sampled(segments, {1.0}, Request().limits));
  GetParam().modify(segments);
  const auto plan = plan_sampled(segments, {1.0}, Request().limits);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, ErrorCode::invalid_goal);
  EXPECT_NE(plan.error().message.find(GetParam().message_part), std::string::npos) << plan.error().message;
}

INSTANTIATE_TEST_SUITE_P(
    Each, InvalidSegmentTest,
    testing::Values(
        InvalidSegment{"NoSegment", [](auto & segments) { segments.clear(); }, "there is no segment"},
        InvalidSegment{"NoPosition", [](auto & segments) { segments.push_back({}); },
                       "segment 1 has 0 positions, 0 parameters and 0 durations"},
        InvalidSegment{"TooFewParameters", [](auto & segments) { segments[0].parameters.pop_back(); },
                       "segment 0 has 3 positions, 2 parameters and 2 durations"},
        InvalidSegment{"TooManyDurations", [](auto & segments) { segments[0].min_durations.push_back(1.0); },
                       "3 durations"},
        InvalidSegment{"PositionNan", [](auto & segments) { segments[0].positions[1][3] = not_a_number; },
                       "sample 1 of segment 0"},
        InvalidSegment{"ParameterRepeated", [](auto & segments) { segments[0].parameters[2] = 0.5; },
                       "sample 2 of segment 0"},
        InvalidSegment{"DurationNegative", [](auto & segments) { segments[0].min_durations[0] = -0.1; },
                       "sample 1 of segment 0"},
        InvalidSegment{"DurationInfinite", [](auto & segments) { segments[0].min_durations[1] = INFINITY; },
                       "sample 2 of segment 0"}),
    [](const auto & bad) { return bad.param.name; });

// Any input results in a verified trajectory or an error; never in a crash, a hang or an invalid plan.
TEST(PlanFuzzTest, YieldsVerifiedPlanOrError)
{
  std::mt19937 random(4711);
  const double strange[]{0.0,  -0.0, 1e-300, 1e-12, 1e-9,  1e-6,         1e-3,     0.1,       1.0,
                         -1.0, 6.29, 1e3,    1e300, -1e-8, not_a_number, INFINITY, -INFINITY, 3.0};
  const auto pick = [&] { return strange[random() % std::size(strange)]; };
  int planned = 0;
  for (int round = 0; round < 3000; ++round) {
    Request request;
    request.waypoints.resize(random() % 12, std::vector<double>(6, 0.0));
    for (auto & waypoint : request.waypoints) {
      for (double & value : waypoint) {
        value = random() % 4 == 0 ? std::fmod(pick(), 6.0) * (random() % 2 == 0 ? 1.0 : 1e-3) : value;
      }
    }
    if (random() % 6 == 0 && !request.waypoints.empty()) {
      request.waypoints[random() % request.waypoints.size()].resize(random() % 9);
    }
    if (random() % 3 == 0) {
      request.options.blend_tolerance = pick();
    }
    if (random() % 5 == 0) {
      request.limits.acceleration[static_cast<int>(random() % 6)] = pick();
      request.limits.jerk[static_cast<int>(random() % 6)] = pick();
    }
    const auto plan = request.plan();
    if (plan) {
      ++planned;
      EXPECT_TRUE(plan->verify(request.limits))
          << "round " << round << ": " << plan->verify(request.limits).error().message;
      EXPECT_TRUE(std::isfinite(plan->duration())) << "round " << round;
    } else {
      EXPECT_FALSE(plan.error().message.empty()) << "round " << round;
    }
  }
  EXPECT_GT(planned, 300);
}

}  // namespace
}  // namespace ur_ros_rtde::trajectory::test
