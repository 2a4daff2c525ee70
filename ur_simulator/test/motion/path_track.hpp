#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "arm_rig.hpp"

namespace ur_simulator::testing {

/// What the tool did, cycle by cycle.
struct Track {
  std::vector<Vector6> poses;
  std::vector<Vector6> joints;
  std::vector<double> speeds;      ///< of the TCP, m/s
  std::vector<std::size_t> begun;  ///< index of the cycle before which each motion began
  std::size_t arrived = 0;         ///< how many cycles until the last motion's call may return

  /// Least distance from a point, m.
  double nearest(const Vector6 & point) const
  {
    double least = 1e9;
    for (const Vector6 & pose : poses) {
      least = std::min(least, (pose - point).head<3>().norm());
    }
    return least;
  }
  double slowest_between(std::size_t from, std::size_t to) const
  {
    return *std::min_element(speeds.begin() + static_cast<long>(from),
                             speeds.begin() + static_cast<long>(to));
  }
  double fastest() const { return *std::max_element(speeds.begin(), speeds.end()); }
  /// Highest change of the tool's velocity vector, m/s^2.
  double hardest(double dt) const
  {
    double result = 0.0;
    for (std::size_t i = 2; i < poses.size(); ++i) {
      const Vector3 bend = (poses[i] - 2.0 * poses[i - 1] + poses[i - 2]).head<3>();
      result = std::max(result, bend.norm() / (dt * dt));
    }
    return result;
  }
};

using Starts = std::vector<std::function<MotionStart()>>;

inline void record(ArmRig & rig, Track & track)
{
  track.poses.push_back(rig.tcp());
  track.joints.push_back(rig.state.target.position);
  track.speeds.push_back(rig.state.target_tcp_speed.head<3>().norm());
}

/// Starts one motion after another, each as soon as the call of the one before may return, as a program does.
inline Track drive(ArmRig & rig, const Starts & starts, double limit = 60.0)
{
  Track track;
  record(rig, track);
  for (const auto & start : starts) {
    const MotionStart motion = start();
    EXPECT_TRUE(motion) << motion.error();
    if (!motion) {
      return track;
    }
    track.begun.push_back(track.poses.size());
    for (double t = 0.0; !rig.arm.finished(*motion) && t < limit; t += rig.dt) {
      rig.step();
      record(rig, track);
    }
    EXPECT_TRUE(rig.arm.finished(*motion));
  }
  track.arrived = track.poses.size();
  for (double t = 0.0; !rig.arm.at_rest() && t < limit; t += rig.dt) {
    rig.step();
    record(rig, track);
  }
  EXPECT_TRUE(rig.arm.at_rest());
  EXPECT_FALSE(rig.arm.take_fault());
  return track;
}

inline Vector6 moved(Vector6 pose, double x, double y, double z)
{
  pose.head<3>() += Vector3(x, y, z);
  return pose;
}

inline Vector6 turned(Vector6 pose, const Vector3 & by)
{
  pose.tail<3>() = to_rotation_vector(to_rotation(pose.tail<3>()) * to_rotation(by));
  return pose;
}

}  // namespace ur_simulator::testing
