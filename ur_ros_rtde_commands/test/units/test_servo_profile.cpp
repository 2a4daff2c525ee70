#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "motion/servo/servo_profile.hpp"
#include "ur_ros_rtde_trajectory/default_speeds.hpp"

namespace ur_ros_rtde {
namespace {

constexpr double tolerance = 1e-4;  // relative, of the numerical derivatives

struct Peak {
  double speed;
  double acceleration;
};

/// The peak speed and acceleration of smooth_step over `distance` in `duration` s.
Peak peak(double distance, double duration)
{
  constexpr int steps = 2000;
  const auto at = [&](int i) { return distance * smooth_step(static_cast<double>(i) / steps); };
  const double dt = duration / steps;
  Peak peak{};
  for (int i = 1; i < steps; ++i) {
    peak.speed = std::max(peak.speed, std::abs(at(i + 1) - at(i - 1)) / (2.0 * dt));
    peak.acceleration =
        std::max(peak.acceleration, std::abs(at(i + 1) - 2.0 * at(i) + at(i - 1)) / (dt * dt));
  }
  return peak;
}

void expect_near(double value, double expected)
{
  EXPECT_NEAR(value, expected, tolerance * expected);
}

TEST(ServoProfileTest, StartsAndEndsAtRest)
{
  EXPECT_DOUBLE_EQ(smooth_step(0.0), 0.0);
  EXPECT_DOUBLE_EQ(smooth_step(0.5), 0.5);
  EXPECT_DOUBLE_EQ(smooth_step(1.0), 1.0);
  EXPECT_LT(smooth_step(0.01), 1e-5);
  EXPECT_GT(smooth_step(0.99), 1.0 - 1e-5);
  expect_near(peak(1.0, 1.0).speed, smooth_step_peak);
}

TEST(ServoProfileTest, LongJointMotionReachesDefaultSpeed)
{
  const double duration = default_joint_duration({}, {0.2, -1.5, 0.0, 0.0, 0.0, 1.0});
  const Peak joint = peak(1.5, duration);
  expect_near(joint.speed, default_joint_speed);
  EXPECT_LT(joint.acceleration, default_joint_acceleration);
}

TEST(ServoProfileTest, ShortJointMotionReachesDefaultAcceleration)
{
  const double duration =
      default_joint_duration({0.1, 0.0, 0.0, 0.0, 0.0, 0.0}, {0.3, 0.0, 0.0, 0.0, 0.0, 0.0});
  const Peak joint = peak(0.2, duration);
  expect_near(joint.acceleration, default_joint_acceleration);
  EXPECT_LT(joint.speed, default_joint_speed);
}

TEST(ServoProfileTest, LongTcpMotionReachesDefaultSpeed)
{
  const double duration =
      default_tcp_duration({0.4, -0.3, 0.5, 0.0, 3.1, 0.0}, {0.7, 0.1, 0.5, 0.0, 3.1, 0.0});
  const Peak tcp = peak(0.5, duration);
  expect_near(tcp.speed, default_linear_speed);
  EXPECT_LT(tcp.acceleration, default_linear_acceleration);
}

TEST(ServoProfileTest, ShortTcpMotionReachesDefaultAcceleration)
{
  expect_near(peak(0.02, default_tcp_duration({}, {0.0, 0.02, 0.0, 0.0, 0.0, 0.0})).acceleration,
              default_linear_acceleration);
}

TEST(ServoProfileTest, RotationOfTcpReachesDefaultSpeed)
{
  expect_near(peak(2.0, default_tcp_duration({}, {0.01, 0.0, 0.0, 0.0, 0.0, 2.0})).speed,
              default_angular_speed);
}

TEST(ServoProfileTest, MotionToTheStartHasAMinimumDuration)
{
  EXPECT_DOUBLE_EQ(default_joint_duration({}, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}), 0.01);
  EXPECT_DOUBLE_EQ(default_tcp_duration({}, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}), 0.01);
}

TEST(ServoProfileTest, InterpolatesJointsAndPosesLinearly)
{
  const std::vector<double> joints =
      interpolate_joints({1.0, 2.0, 0.0, 0.0, 0.0, 0.0}, {2.0, 0.0, 0.0, 0.0, 0.0, 4.0}, 0.25);
  EXPECT_EQ(joints, (std::vector<double>{1.25, 1.5, 0.0, 0.0, 0.0, 1.0}));
  const std::vector<double> pose =
      interpolate_pose({0.4, -0.3, 0.5, 0.0, 0.0, 1.0}, {0.4, 0.1, 0.5, 0.0, 0.0, 2.0}, 0.25);
  const std::vector<double> expected{0.4, -0.2, 0.5, 0.0, 0.0, 1.25};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(pose[i], expected[i], 1e-9) << i;
  }
}

TEST(ServoProfileTest, DistanceBetweenPoses)
{
  const PoseDistance distance =
      pose_distance({0.4, -0.3, 0.5, 0.0, 0.0, 1.0}, {0.7, 0.1, 0.5, 0.0, 0.0, 0.2});
  EXPECT_NEAR(distance.linear, 0.5, 1e-9);
  EXPECT_NEAR(distance.angular, 0.8, 1e-9);
}

}  // namespace
}  // namespace ur_ros_rtde
