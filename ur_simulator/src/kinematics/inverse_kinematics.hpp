#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <tl/expected.hpp>

#include "common/types.hpp"
#include "kinematics/robot_model.hpp"

namespace ur_simulator {

/// All joint positions that reach a pose: at most eight (shoulder left/right, wrist up/down, elbow up/down).
struct InverseSolutions {
  std::array<Vector6, 8> joints;  ///< each joint in (-pi, pi]
  std::size_t count = 0;

  const Vector6 * begin() const { return joints.data(); }
  const Vector6 * end() const { return joints.data() + count; }
};

enum class InverseError {
  unreachable,    ///< no joint position reaches the pose
  beyond_limits,  ///< every joint position that reaches the pose violates a joint limit
};

/// Closed-form solution for UR arms: axes 2, 3 and 4 are parallel, the wrist axes intersect pairwise. Where
/// axes 4 and 6 are parallel (wrist singularity), joint 6 is free and keeps its value in `seed`.
InverseSolutions all_inverse_solutions(const RobotModel & model, const Transform & flange,
                                       const Vector6 & seed);
/// The solution nearest to `seed` (least sum of squared joint differences) with all joints within their
/// limits. Multiples of 2 pi are added where they bring a joint nearer.
/// Calibrated kinematics have no closed form: they are solved by Newton's method, from `seed` or else from
/// the closed-form solution for the same lengths.
tl::expected<Vector6, InverseError> nearest_inverse_solution(const RobotModel & model,
                                                             const Transform & flange, const Vector6 & seed);

/// URScript get_inverse_kin(x, qnear, maxPositionError) with the active TCP. The tolerances are those of the
/// robot's iterative solver; this solution is exact. For a pose just out of reach, returns the solution of
/// the nearest reachable pose towards the shoulder if that lies within `position_tolerance` (m). The
/// orientation is always exact; maxOrientationError is not needed.
tl::expected<Vector6, std::string> get_inverse_kin(const RobotModel & model, const Vector6 & tcp_pose,
                                                   const Vector6 & qnear, const Vector6 & tcp_offset,
                                                   double position_tolerance = 1e-10);

/// Distance from the nearest singularity, 0 at a singularity: the minimum of |sin q5| (wrist), |sin q3|
/// (elbow) and the distance of the wrist from the base axis divided by the length of upper arm and forearm
/// (shoulder).
double singularity_distance(const RobotModel & model, const Vector6 & joints);

}  // namespace ur_simulator
