#pragma once

#include <vector>

#include "motion/grid.hpp"
#include "path/path.hpp"
#include "ur_ros_rtde_trajectory/trajectory.hpp"

namespace ur_ros_rtde::trajectory {

/// Position u on a piece of the path, from its start, and its time derivatives: speed, acceleration, jerk.
struct PathState {
  double u = 0.0, v = 0.0, a = 0.0, j = 0.0;
};

/// Polynomial u(t) = sum c[k] (t - start)^k, while the motion is on one piece of the path.
struct TimingLawPiece {
  double start = 0.0;     // s
  double duration = 0.0;  // s
  std::size_t piece = 0;
  double c[6] = {0, 0, 0, 0, 0, 0};

  double end() const { return start + duration; }
  PathState at(double time) const;
};

/// Path with its timing law: the data of a Trajectory.
struct Motion {
  std::shared_ptr<const Path> path;
  std::vector<TimingLawPiece> timing;

  double duration() const { return timing.empty() ? 0.0 : timing.back().end(); }
  std::size_t piece_at(double time) const;
  /// Whether all numbers of the pieces from `first` on are finite.
  bool is_finite(std::size_t first = 0) const;

  /// Appends the solution of a solver. `constant_acceleration`: the profile is that of TOPP-RA.
  void append(const Grid & grid, const Profile & profile, bool constant_acceleration);
  /// Appends a phase of constant jerk (or acceleration) along the path.
  void append(std::size_t path_piece, double duration, const PathState & from);
  /// Appends a piece between two states. Its speed is a cubic in time if the duration matches, otherwise a
  /// quartic.
  void append(std::size_t path_piece, double duration, const PathState & from, const PathState & to);
  /// Multiplies the durations of the pieces from `first` on by `factor`.
  void stretch(double factor, std::size_t first = 0);
};

/// Setpoint of the joints for a state on a path, by the chain rule.
Point joint_motion(const PathPoint & point, const PathState & path_state);

}  // namespace ur_ros_rtde::trajectory
