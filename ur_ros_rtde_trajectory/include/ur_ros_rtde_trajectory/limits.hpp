#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <string_view>

#include "ur_ros_rtde_trajectory/arm_limits.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde::trajectory {

inline constexpr int joint_count = 6;

/// One value per joint, base to wrist 3: rad, rad/s, rad/s^2 or rad/s^3. The number of joints is fixed
/// because every UR arm has six joints, and fixed sizes keep the solver free of allocations.
using Joints = Eigen::Array<double, joint_count, 1>;

inline constexpr double unlimited = std::numeric_limits<double>::infinity();
/// Defaults if the caller specifies none. Universal Robots publishes no acceleration limits of the joints.
/// These values suit every model with its rated payload, like those in MoveIt configurations.
inline constexpr double default_acceleration = 5.0;  ///< rad/s^2
inline constexpr double default_jerk = 100.0;        ///< rad/s^3: full acceleration after 0.05 s

/// Limits of each joint. Positions lie within [position_min, position_max]; the other limits are symmetric.
struct Limits {
  Joints position_min = Joints::Constant(-unlimited);  ///< rad
  Joints position_max = Joints::Constant(unlimited);   ///< rad
  Joints velocity = Joints::Constant(unlimited);       ///< rad/s, > 0
  Joints acceleration = Joints::Constant(unlimited);   ///< rad/s^2, > 0
  Joints jerk = Joints::Constant(unlimited);  ///< rad/s^3, > 0; `unlimited` for all six: no jerk limit

  /// False if no joint has a jerk limit. The acceleration may then be discontinuous.
  bool has_jerk() const { return jerk.isFinite().any(); }
};

/// Position and velocity limits of an arm, with the same acceleration and jerk limit for every joint.
Limits make_limits(const ArmLimits & arm, double acceleration = default_acceleration,
                   double jerk = default_jerk);

/// `limits` with velocities and accelerations reduced to at most default_joint_speed and
/// default_joint_acceleration (default_speeds.hpp).
Limits default_speed_limits(Limits limits);

/// Checks the limits. Velocity, acceleration and jerk limits must be between 1e-4 and 1e7; only jerk limits
/// may be infinite. Position ranges must not be empty.
Status check(const Limits & limits);

/// Joint name as in the ROS description: "shoulder_pan_joint", …
std::string_view joint_name(int joint);

/// Converts `values` to Joints. Returns an error that names `field` if there are not six values or a value is
/// not finite.
Expected<Joints> to_joints(std::string_view field, const std::vector<double> & values);

}  // namespace ur_ros_rtde::trajectory
