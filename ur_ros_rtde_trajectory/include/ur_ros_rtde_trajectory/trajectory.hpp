#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>

#include "ur_ros_rtde_trajectory/limits.hpp"

namespace ur_ros_rtde::trajectory {

struct Motion;

inline constexpr double max_duration = 86400.0;  ///< s, of a plan

/// Joint setpoint at one instant of a trajectory.
struct Point {
  Joints position = Joints::Zero();
  Joints velocity = Joints::Zero();
  Joints acceleration = Joints::Zero();
  Joints jerk = Joints::Zero();  ///< at a discontinuity: the value after it
};

/// Largest utilization of each limit anywhere on a trajectory, as a fraction; 1 is the limit.
struct Utilization {
  double velocity = 0.0, acceleration = 0.0, jerk = 0.0;
};

/// Motion of the six joints over time, at rest at both ends unless created otherwise. Immutable and cheap to
/// copy: copies share their data, and any thread may sample them.
class Trajectory {
 public:
  explicit Trajectory(std::shared_ptr<const Motion> motion) : motion_(std::move(motion)) {}

  /// s
  double duration() const;
  /// Setpoint at `time` in s. Before 0 and after the end: the first or last position, at rest.
  Point sample(double time) const;
  /// Fraction of the path length covered at `time`, 0 to 1.
  double progress(double time) const;

  std::size_t waypoint_count() const;
  /// Time in s at which the motion passes the waypoint, or its nearest point if the path is blended. If a
  /// stop ends before the waypoint: the duration.
  double time_of_waypoint(std::size_t waypoint) const;
  /// Index of the last waypoint reached at `time`.
  std::size_t waypoint_at(double time) const;

  /// Follows this trajectory until `time`, then brakes to rest along the same path as fast as `limits` (those
  /// it was planned with) allow. If the motion is already decelerating at the limits, braking harder starts
  /// once there is headroom. Both trajectories share their time axis, so it is possible to
  /// switch at any time up to `time`. Returns this trajectory if no stop ends earlier than the plan itself,
  /// and nothing if the search, which takes about a millisecond, has not ended by `deadline`.
  std::optional<Trajectory> stop_from(double time, const Limits & limits,
                                      std::chrono::steady_clock::time_point deadline) const;

  /// The same motion with velocities scaled by `fraction` and accelerations by its square.
  Trajectory slowed(double fraction) const;

  /// Checks every interval of the trajectory in steps of at most `step` seconds. The error names joint, time,
  /// waypoint, value and limit of the first violation.
  Expected<Utilization> verify(const Limits & limits, double step = 0.002) const;

  const Motion & motion() const { return *motion_; }

 private:
  std::shared_ptr<const Motion> motion_;
};

}  // namespace ur_ros_rtde::trajectory
