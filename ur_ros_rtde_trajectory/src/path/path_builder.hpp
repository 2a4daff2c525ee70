#pragma once

#include <vector>

#include "path/path.hpp"

namespace ur_ros_rtde::trajectory {

struct PathShape {
  /// Largest distance of the path from a waypoint, in the joint that deviates most, in rad. 0: through every
  /// waypoint.
  double tolerance = 0.0;
  /// A waypoint where the direction changes by more than this angle is a corner. With tolerance 0, a smooth
  /// spline passes through the other waypoints. In rad; 0: straight lines only, with a stop at every waypoint
  /// where the direction changes.
  double corner_angle = 0.35;
};

/// Builds the path through `waypoints` (at least one). Repeated waypoints have the same s.
Path build_path(const std::vector<Joints> & waypoints, const PathShape & shape);

}  // namespace ur_ros_rtde::trajectory
