#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/error_code.hpp"
#include "kinematics/link_shapes.hpp"
#include "kinematics/robot_model.hpp"
#include "state/controller_state.hpp"
#include "world/world.hpp"

namespace ur_simulator {

/// Two bodies that touch each other.
struct Collision {
  ErrorCode code;
  std::string description;  ///< what touches what, and the remedy
};

/// Decides when the overlap of two bodies is a new collision. Bodies that overlap from the beginning are none
/// until they have been apart.
class OverlapMonitor {
 public:
  /// `depth`: by how much the bodies overlap, m; negative: their distance.
  bool collides(double depth);

 private:
  std::optional<double> tolerated_depth_;  ///< m; empty before the first call
};

/// Detects collisions of the links with each other and with the objects of the world. The wrist 3 and the
/// tool touch objects elastically at the TCP instead (World).
class CollisionMonitor {
 public:
  explicit CollisionMonitor(const RobotModel & model);

  /// Call once per cycle. Returns the first of the collisions that have begun in this cycle.
  std::optional<Collision> check(const World & world, const ControllerState & state);
  /// Tolerates the current overlaps: call when the arm has been placed elsewhere.
  void reset();

 private:
  struct SelfPair {
    Body first;
    Body second;
    OverlapMonitor monitor;
  };
  /// One for each body; the base and the wrist 3 do not use theirs.
  using BodyMonitors = std::array<OverlapMonitor, body_count>;
  using Monitors = std::map<std::uint32_t, BodyMonitors>;  ///< by the identifier of the object

  double overlap(Body first, Body second) const;
  double clamping_overlap(const Vector3 & flange) const;
  void check_self(const Vector3 & flange, std::optional<Collision> & found);
  template <typename Object>
  void check_objects(const ObjectList<Object> & objects, Monitors & monitors, const char * name,
                     std::optional<Collision> & found) const;

  const RobotModel & model_;
  std::vector<Capsule> capsules_;  ///< in the frames of their links
  std::vector<Capsule> placed_;    ///< in the base frame, in this cycle
  std::size_t forearm_tube_ = 0;   ///< index of the longest capsule of the forearm
  std::vector<SelfPair> self_pairs_;
  OverlapMonitor clamping_;
  Monitors surfaces_;
  Monitors boxes_;
};

}  // namespace ur_simulator
