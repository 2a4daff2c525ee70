#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <tl/expected.hpp>

#include "common/types.hpp"
#include "kinematics/robot_model.hpp"

namespace ur_simulator {

/// All postures that reach a pose: at most eight (shoulder left/right, wrist up/down, elbow up/down).
struct InverseSolutions {
  std::array<Vector6, 8> joints;  ///< each joint in (-pi, pi]
  std::size_t count = 0;

  const Vector6 * begin() const { return joints.data(); }
  const Vector6 * end() const { return joints.data() + count; }
};

enum class InverseError {
  unreachable,    ///< no posture reaches the pose
  beyond_limits,  ///< one does, but with a joint beyond its limits
};

/// Closed form (the geometry of UR arms: axes 2, 3, 4 parallel, wrist axes pairwise crossing). Where axes 4
/// and 6 are parallel (wrist singularity) joint 6 is free and takes the value it has in `seed`.
InverseSolutions inverse_all(const RobotModel & model, const Transform & flange, const Vector6 & seed);
/// The posture nearest to `seed` (least sum of squares of joint differences) with all joints within their
/// limits; whole turns are added where that brings a joint nearer.
tl::expected<Vector6, InverseError> inverse_nearest(const RobotModel & model, const Transform & flange,
                                                    const Vector6 & seed);

/// get_inverse_kin(x, qnear, maxPositionError) with the active TCP. The tolerances belong to the iterative
/// solver of the robot; here the solution is exact. A pose just out of reach is answered by the nearest one
/// towards the shoulder that can be reached, when that lies within `position_tolerance` (m). The orientation
/// is always exact, so URScript's maxOrientationError has no use here.
tl::expected<Vector6, std::string> get_inverse_kin(const RobotModel & model, const Vector6 & tcp_pose,
                                                   const Vector6 & qnear, const Vector6 & tcp_offset,
                                                   double position_tolerance = 1e-10);

/// How far from a singularity: 0 at one. |sin q5| (wrist), |sin q3| (elbow) and the distance of the wrist
/// from the base's axis over the arm's reach (shoulder); the least of the three.
double dexterity(const RobotModel & model, const Vector6 & joints);

}  // namespace ur_simulator
