#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "common/segment.hpp"
#include "kinematics/robot_model.hpp"

namespace ur_simulator {

/// The rigid bodies of the arm: the base, and the link that each joint moves.
enum class Body : std::size_t { base, shoulder, upper_arm, forearm, wrist_1, wrist_2, wrist_3 };
constexpr std::size_t body_count = 7;
/// "base", "upper arm", …
std::string_view to_string(Body body);

/// A cylinder of a body, as in the package ur_ros_rtde_description: positions in the frame of the link's
/// Denavit-Hartenberg row, those of the base in the base frame.
struct LinkCylinder {
  Body body;
  Segment axis;  ///< between the centers of the two ends
  double radius;
  /// No other part of the arm continues the cylinder at axis.end.
  bool free_end;
};

std::vector<LinkCylinder> link_cylinders(const RobotModel & model);

/// A cylinder with hemispheres at its ends.
struct Capsule {
  Body body;
  Segment axis;
  double radius;
};

/// Capsules inside the cylinders: shorter by the radius at free ends. At joints, the hemisphere lies in the
/// next body.
std::vector<Capsule> link_capsules(const RobotModel & model);
/// The capsule in the base frame. `frames` as of link_frames().
Capsule in_base_frame(const Capsule & capsule, const std::array<Transform, 6> & frames);

}  // namespace ur_simulator
