#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <string_view>

#include "ur_ros_rtde_trajectory/arm_limits.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde::trajectory {

inline constexpr int joint_count = 6;

/// One value per joint, base to wrist 3. rad, rad/s, rad/s^2 or rad/s^3. The number of joints is fixed: every
/// UR arm has six, and fixed sizes keep the solver free of allocations.
using Joints = Eigen::Array<double, joint_count, 1>;

inline constexpr double unlimited = std::numeric_limits<double>::infinity();
/// Defaults where the caller gives none: Universal Robots publishes no acceleration limit of the joints;
/// these are gentle enough for every model with its rated payload, as MoveIt's configurations are.
inline constexpr double default_acceleration = 5.0;  ///< rad/s^2
inline constexpr double default_jerk = 100.0;        ///< rad/s^3: full acceleration after 0.05 s

/// What each joint may do. Positions lie within [position_min, position_max]; the others are symmetric.
struct Limits {
  Joints position_min = Joints::Constant(-unlimited);  ///< rad
  Joints position_max = Joints::Constant(unlimited);   ///< rad
  Joints velocity = Joints::Constant(unlimited);       ///< rad/s, > 0
  Joints acceleration = Joints::Constant(unlimited);   ///< rad/s^2, > 0
  Joints jerk = Joints::Constant(unlimited);  ///< rad/s^3, > 0; `unlimited` for all six: no jerk limit

  /// False when no joint has a jerk limit: the acceleration may then jump.
  bool has_jerk() const { return jerk.isFinite().any(); }
};

/// The position and velocity limits of an arm, with the same acceleration and jerk limit for every joint.
Limits make_limits(const ArmLimits & arm, double acceleration = default_acceleration,
                   double jerk = default_jerk);

/// `limits`, with velocities and accelerations of at most default_joint_speed and default_joint_acceleration
/// (default_speeds.hpp).
Limits default_speed_limits(Limits limits);

/// Refuses limits that are zero, negative, NaN or beyond 1e-4 to 1e7, an empty position range, and what
/// time-optimal timing cannot do without: finite velocity and acceleration limits.
Status check(const Limits & limits);

/// "shoulder_pan_joint", … as ROS names them.
std::string_view joint_name(int joint);

/// `values` as Joints; refused, naming `field`, when there are not six or one is not finite.
Expected<Joints> to_joints(std::string_view field, const std::vector<double> & values);

}  // namespace ur_ros_rtde::trajectory
