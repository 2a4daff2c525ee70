#pragma once

#include "common/types.hpp"

namespace ur_simulator {

/// A line segment, m. Begin and end may be equal.
struct Segment {
  Vector3 begin = Vector3::Zero();
  Vector3 end = Vector3::Zero();
};

/// Shortest distance between two segments.
double distance(const Segment & a, const Segment & b);
/// Shortest distance between a segment and a box, 0 if they intersect. The box is centered at the origin, its
/// edges are parallel to the axes.
double distance_from_box(const Segment & segment, const Vector3 & half_size);

}  // namespace ur_simulator
