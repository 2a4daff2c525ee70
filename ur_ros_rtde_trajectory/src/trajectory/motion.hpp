#pragma once

#include <vector>

#include "path/path.hpp"
#include "timing/grid.hpp"
#include "ur_ros_rtde_trajectory/trajectory.hpp"

namespace ur_ros_rtde::trajectory {

/// Place on a piece of the path, from its beginning, and its derivatives by time.
struct PathState {
  double u = 0.0, v = 0.0, a = 0.0, j = 0.0;
};

/// u(t) = sum c[k] (t - start)^k while the motion is on one piece of the path.
struct TimingLawPiece {
  double start = 0.0;     // s
  double duration = 0.0;  // s
  std::size_t piece = 0;
  double c[6] = {0, 0, 0, 0, 0, 0};

  double end() const { return start + duration; }
  PathState at(double time) const;
};

/// A path and when the motion is where on it: what a Trajectory is made of.
struct Motion {
  std::shared_ptr<const Path> path;
  std::vector<TimingLawPiece> timing;

  double duration() const { return timing.empty() ? 0.0 : timing.back().end(); }
  std::size_t piece_at(double time) const;

  /// Adds what a solver found, from the end of what is here. `constant_acceleration`: of the TOPP2 solver's
  /// profile.
  void append(const Grid & grid, const Profile & profile, bool constant_acceleration);
  /// A phase of constant jerk (or acceleration) along the path.
  void append(std::size_t path_piece, double duration, const PathState & from);
  /// The piece between two states whose speed is a cubic (when the duration fits it, else a quartic) in time.
  void append(std::size_t path_piece, double duration, const PathState & from, const PathState & to);
  /// Slows down the pieces from `first` on: their durations times `factor`.
  void stretch(double factor, std::size_t first = 0);
};

/// Joint motion at a place of a path.
Point joint_motion(const PathPoint & point, const PathState & place);

}  // namespace ur_ros_rtde::trajectory
