#pragma once

#include <cstddef>
#include <memory>

#include "ur_ros_rtde_trajectory/limits.hpp"

namespace ur_ros_rtde::trajectory {

struct Motion;

/// Where the joints are to be at a time.
struct Point {
  Joints position = Joints::Zero();
  Joints velocity = Joints::Zero();
  Joints acceleration = Joints::Zero();
  Joints jerk = Joints::Zero();  ///< where it jumps: of the later side
};

/// Largest use of each limit anywhere on a trajectory, as a fraction: 1 is the limit.
struct Utilization {
  double velocity = 0.0, acceleration = 0.0, jerk = 0.0;
};

/// A motion of the six joints over time, from rest to rest unless it was made otherwise. Immutable and cheap
/// to copy: copies share their data, and any thread may sample them.
class Trajectory {
 public:
  explicit Trajectory(std::shared_ptr<const Motion> motion) : motion_(std::move(motion)) {}

  /// s
  double duration() const;
  /// At `time` seconds after the beginning; before it and after the end: the position there, at rest.
  Point sample(double time) const;
  /// Part of the path covered at `time`, 0 to 1.
  double progress(double time) const;

  std::size_t waypoint_count() const;
  /// When the motion is at the waypoint (at its nearest point, where the path is blended). s; after a stop
  /// that does not reach the waypoint: the duration.
  double time_of_waypoint(std::size_t waypoint) const;
  /// The last waypoint reached at `time`.
  std::size_t waypoint_at(double time) const;

  /// This trajectory until `time`, then along the same path to rest, as soon as `limits` (those it was
  /// planned with) allow. Where the motion already brakes with all they allow, the additional braking begins
  /// when they leave room. Its time axis is this trajectory's: switch to it at any moment up to `time`.
  /// Finding it takes about a millisecond, at worst some tens: ask for a `time` that far ahead. Where nothing
  /// stops sooner than the plan itself, the plan.
  Trajectory stop_from(double time, const Limits & limits) const;

  /// The same motion at `fraction` of the speed: velocities times fraction, accelerations times its square.
  Trajectory slowed(double fraction) const;

  /// Looks at every interval of the trajectory in steps no longer than `step` seconds. The error names limit,
  /// joint, time, waypoint, value and limit of the first excess.
  Expected<Utilization> verify(const Limits & limits, double step = 0.002) const;

  const Motion & motion() const { return *motion_; }

 private:
  std::shared_ptr<const Motion> motion_;
};

}  // namespace ur_ros_rtde::trajectory
