#include "safety/collision_monitor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "common/pose.hpp"
#include "kinematics/forward_kinematics.hpp"

namespace ur_simulator {
namespace {

constexpr double separation = 1e-3;     // m: bodies with this distance are apart
constexpr double further_depth = 5e-3;  // m beyond a reported overlap: reported again
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Pairs of bodies that can touch. Neighbors cannot, nor can base and upper arm, wrist 1 and wrist 3; forearm
/// and wrist 3 are kept further apart, see clamping_distance().
constexpr std::pair<Body, Body> self_pairs[] = {
    {Body::base, Body::forearm},      {Body::base, Body::wrist_1},      {Body::base, Body::wrist_2},
    {Body::base, Body::wrist_3},      {Body::shoulder, Body::forearm},  {Body::shoulder, Body::wrist_1},
    {Body::shoulder, Body::wrist_2},  {Body::shoulder, Body::wrist_3},  {Body::upper_arm, Body::wrist_1},
    {Body::upper_arm, Body::wrist_2}, {Body::upper_arm, Body::wrist_3}, {Body::forearm, Body::wrist_2},
    {Body::forearm, Body::wrist_3}};

/// Least distance between a cylinder around the forearm and a sphere around the flange, m. Distance and
/// shapes: UR's statement about the UR5e in the UR forum, "Error C403A0: Danger of clamping between the robot
/// lower arm and tool". The radii are those of the joints of the wrist: for other e-Series models an
/// estimate. 0: not checked, no source for this series.
double clamping_distance(const RobotModel & model)
{
  return model.series == Series::e_series ? 0.028 : 0.0;
}

double length(const Segment & segment)
{
  return (segment.end - segment.begin).norm();
}

/// Returns a function that calculates by how much a capsule overlaps with the object, m.
auto overlap_with(const Surface & surface)
{
  return [&surface](const Capsule & capsule) {
    const double height = std::min(surface.normal.dot(capsule.axis.begin - surface.point),
                                   surface.normal.dot(capsule.axis.end - surface.point));
    return capsule.radius - height;
  };
}

auto overlap_with(const Box & box)
{
  const Eigen::Matrix3d to_box = to_rotation_matrix(box.rotation).transpose();
  const double box_radius = 0.5 * box.size.norm();
  return [&box, to_box, box_radius](const Capsule & capsule) {
    const Vector3 middle = 0.5 * (capsule.axis.begin + capsule.axis.end);
    const double bound =
        capsule.radius + 0.5 * length(capsule.axis) + box_radius - (middle - box.center).norm();
    if (bound < -separation) {
      return bound;  // of the spheres around both: the overlap is less
    }
    const Segment axis{to_box * (capsule.axis.begin - box.center), to_box * (capsule.axis.end - box.center)};
    return capsule.radius - distance_from_box(axis, 0.5 * box.size);
  };
}

bool touches_objects(Body body)
{
  return body != Body::base && body != Body::wrist_3;
}

}  // namespace

bool OverlapMonitor::collides(double depth)
{
  if (!tolerated_depth_) {
    tolerated_depth_ = depth > 0.0 ? infinity : 0.0;
  }
  if (depth < -separation) {
    tolerated_depth_ = 0.0;
  }
  if (depth <= *tolerated_depth_) {
    return false;
  }
  tolerated_depth_ = depth + further_depth;
  return true;
}

CollisionMonitor::CollisionMonitor(const RobotModel & model)
    : model_(model), capsules_(link_capsules(model)), placed_(capsules_)
{
  for (std::size_t i = 0; i < capsules_.size(); ++i) {
    const bool longer = length(capsules_[i].axis) > length(capsules_[forearm_tube_].axis);
    if (capsules_[i].body == Body::forearm && (capsules_[forearm_tube_].body != Body::forearm || longer)) {
      forearm_tube_ = i;
    }
  }
  for (const auto & [first, second] : self_pairs) {
    self_pairs_.push_back({first, second, {}});
  }
}

void CollisionMonitor::reset()
{
  for (SelfPair & pair : self_pairs_) {
    pair.monitor = {};
  }
  clamping_ = {};
  surfaces_.clear();
  boxes_.clear();
}

std::optional<Collision> CollisionMonitor::check(const World & world, const ControllerState & state)
{
  const auto frames = link_frames(model_, state.actual.position);
  std::ranges::transform(capsules_, placed_.begin(),
                         [&](const Capsule & capsule) { return in_base_frame(capsule, frames); });
  std::optional<Collision> found;
  check_self(frames[5].translation(), found);
  check_objects(world.surfaces(), surfaces_, "surface", found);
  check_objects(world.boxes(), boxes_, "box", found);
  return found;
}

double CollisionMonitor::overlap(Body first, Body second) const
{
  double depth = -infinity;
  for (const Capsule & a : placed_) {
    if (a.body != first) {
      continue;
    }
    for (const Capsule & b : placed_) {
      if (b.body == second) {
        depth = std::max(depth, a.radius + b.radius - distance(a.axis, b.axis));
      }
    }
  }
  return depth;
}

double CollisionMonitor::clamping_overlap(const Vector3 & flange) const
{
  const double least_distance = model_.joint_radius[3] + model_.joint_radius[5] + clamping_distance(model_);
  return least_distance - distance(placed_[forearm_tube_].axis, {flange, flange});
}

void CollisionMonitor::check_self(const Vector3 & flange, std::optional<Collision> & found)
{
  for (SelfPair & pair : self_pairs_) {
    if (pair.monitor.collides(overlap(pair.first, pair.second)) && !found) {
      found = {error_codes::collision_detected,
               fmt::format(
                   "the {} touches the {}: collision of the arm with itself; move it away, in freedrive or "
                   "by the pendant",
                   to_string(pair.second), to_string(pair.first))};
    }
  }
  if (clamping_distance(model_) > 0.0 && clamping_.collides(clamping_overlap(flange)) && !found) {
    found = {
        error_codes::danger_of_clamping,
        fmt::format(
            "the tool flange is too near to the lower arm: danger of clamping, the distance must be {:g} "
            "mm; move it away",
            1e3 * clamping_distance(model_))};
  }
}

template <typename Object>
void CollisionMonitor::check_objects(const ObjectList<Object> & objects, Monitors & monitors,
                                     const char * name, std::optional<Collision> & found) const
{
  std::erase_if(monitors, [&](const auto & entry) {
    return std::ranges::find(objects, entry.first, &ObjectList<Object>::Entry::id) == objects.end();
  });
  for (const auto & [id, object] : objects) {
    const auto overlap_of = overlap_with(object);
    std::array<double, body_count> depths;
    depths.fill(-infinity);
    for (const Capsule & capsule : placed_) {
      double & depth = depths[static_cast<std::size_t>(capsule.body)];
      depth = touches_objects(capsule.body) ? std::max(depth, overlap_of(capsule)) : depth;
    }
    BodyMonitors & of_object = monitors[id];
    for (std::size_t body = 0; body < body_count; ++body) {
      if (of_object[body].collides(depths[body]) && !found) {
        found = {error_codes::collision_detected,
                 fmt::format("the {} touches {} {}: collision; move it away, in freedrive or by the pendant",
                             to_string(static_cast<Body>(body)), name, id)};
      }
    }
  }
}

}  // namespace ur_simulator
