#pragma once

#include <vector>

#include "path/path.hpp"

namespace ur_ros_rtde::trajectory {

struct PathShape {
  /// How far the path may pass from a waypoint, in the joint that deviates most. rad. 0: through every
  /// waypoint.
  double tolerance = 0.0;
  /// A waypoint where the direction changes by more than this is a corner; at the others, with tolerance 0, a
  /// spline passes through smoothly. rad. 0: straight lines only, a stop at every waypoint that turns.
  double corner_angle = 0.35;
};

/// The path through `waypoints` (at least one). Waypoints that repeat their predecessor share its place.
Path build_path(const std::vector<Joints> & waypoints, const PathShape & shape);

}  // namespace ur_ros_rtde::trajectory
