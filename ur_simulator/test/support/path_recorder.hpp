#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "support/arm_fixture.hpp"

namespace ur_simulator::testing {

/// Recorded path of the TCP, one entry per cycle.
struct RecordedPath {
  std::vector<Vector6> poses;
  std::vector<Vector6> joints;
  std::vector<double> speeds;              ///< of the TCP, m/s
  std::vector<std::size_t> motion_starts;  ///< index of the first entry of each motion
  std::size_t call_complete_at = 0;        ///< number of entries until the call of the last motion returned

  /// Shortest distance of the path from a point, m.
  double distance_from(const Vector6 & point) const
  {
    double distance = 1e9;
    for (const Vector6 & pose : poses) {
      distance = std::min(distance, (pose - point).head<3>().norm());
    }
    return distance;
  }
  double min_speed_between(std::size_t from, std::size_t to) const
  {
    return *std::min_element(speeds.begin() + static_cast<long>(from),
                             speeds.begin() + static_cast<long>(to));
  }
  double max_speed() const { return *std::max_element(speeds.begin(), speeds.end()); }
  /// Highest acceleration of the TCP, m/s^2.
  double max_acceleration(double dt) const
  {
    double result = 0.0;
    for (std::size_t i = 2; i < poses.size(); ++i) {
      const Vector3 difference = (poses[i] - 2.0 * poses[i - 1] + poses[i - 2]).head<3>();
      result = std::max(result, difference.norm() / (dt * dt));
    }
    return result;
  }
};

using Starts = std::vector<std::function<StartResult()>>;

inline void record(ArmFixture & fixture, RecordedPath & path)
{
  path.poses.push_back(fixture.tcp());
  path.joints.push_back(fixture.state.target.position);
  path.speeds.push_back(fixture.state.target_tcp_speed.head<3>().norm());
}

/// Executes motions like a program: each starts when the call of the previous one returns.
inline RecordedPath execute(ArmFixture & fixture, const Starts & starts, double limit = 60.0)
{
  RecordedPath path;
  record(fixture, path);
  for (const auto & start : starts) {
    const StartResult motion = start();
    EXPECT_TRUE(motion) << motion.error();
    if (!motion) {
      return path;
    }
    path.motion_starts.push_back(path.poses.size());
    for (double t = 0.0; !fixture.arm.call_complete(*motion) && t < limit; t += fixture.dt) {
      fixture.step();
      record(fixture, path);
    }
    EXPECT_TRUE(fixture.arm.call_complete(*motion));
  }
  path.call_complete_at = path.poses.size();
  for (double t = 0.0; !fixture.arm.at_rest() && t < limit; t += fixture.dt) {
    fixture.step();
    record(fixture, path);
  }
  EXPECT_TRUE(fixture.arm.at_rest());
  EXPECT_FALSE(fixture.arm.take_fault());
  return path;
}

inline Vector6 moved(Vector6 pose, double x, double y, double z)
{
  pose.head<3>() += Vector3(x, y, z);
  return pose;
}

inline Vector6 turned(Vector6 pose, const Vector3 & by)
{
  pose.tail<3>() = to_rotation_vector(to_rotation_matrix(pose.tail<3>()) * to_rotation_matrix(by));
  return pose;
}

}  // namespace ur_simulator::testing
