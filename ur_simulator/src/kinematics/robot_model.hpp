#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "common/types.hpp"

namespace ur_simulator {

/// CB3 (125 Hz, PolyScope 3), e-Series (UR3e to UR16e) and UR Series (UR8 Long, UR15 to UR30), both 500 Hz.
enum class Series { cb3, e_series, ur_series };

/// One link in the frame of its Denavit-Hartenberg row (frame i is fixed to link i).
struct Link {
  double mass;              ///< kg
  Vector3 center_of_mass;   ///< m
  Eigen::Matrix3d inertia;  ///< kg m^2, about the center of mass
};

/// Published data of one robot model. DH parameters are standard (not modified): Rz(theta) Tz(d) Tx(a)
/// Rx(alpha). Source: Universal Robots, "DH Parameters for calculations of kinematics and dynamics"; inertias
/// and limits: UniversalRobots/Universal_Robots_ROS2_Description, config/<model>/.
struct RobotModel {
  std::string name;            ///< "ur10e"
  std::string display_name;    ///< "UR10e"
  std::string dashboard_name;  ///< "UR10", the answer of the dashboard command `get robot model`
  std::uint8_t
      type_number;  ///< robot type in the messages of the primary interface (UR5 1, UR10 2, UR3 3, UR16 4, …)
  Series series;
  Vector6 a;                ///< m
  Vector6 d;                ///< m
  Vector6 alpha;            ///< rad
  Vector6 theta;            ///< rad, added to the joint positions; 0 in the nominal kinematics
  bool calibrated = false;  ///< a, d, alpha and theta deviate from the nominal kinematics
  std::array<Link, 6> links;
  Vector6 position_min;      ///< rad
  Vector6 position_max;      ///< rad; infinite for continuous joints (UR3, UR3e: wrist 3)
  Vector6 velocity_max;      ///< rad/s
  Vector6 acceleration_max;  ///< rad/s^2, highest acceleration of motions
  Vector6 torque_max;        ///< N m
  Vector6 stiffness;         ///< N m/rad of each joint
  Vector6 torque_constant;   ///< N m/A at the joint, after the gear
  Vector6 joint_radius;      ///< m, of the housings
  double upper_arm_offset;   ///< m, of the tube of the upper arm from the origin of its link, along the
                             ///< joint's axis
  double forearm_offset;     ///< m, the same for the forearm
  double payload_max;        ///< kg, rated
  double reach;              ///< m

  bool has_force_torque_sensor() const { return series != Series::cb3; }
  double cycle_time() const { return series == Series::cb3 ? 0.008 : 0.002; }
};

/// All models, each once.
std::span<const RobotModel> robot_models();
/// Finds a model by name; case, spaces, '-' and '_' are ignored ("UR10e", "ur8 long"). The error lists the
/// known models.
tl::expected<std::reference_wrapper<const RobotModel>, std::string> find_robot_model(std::string_view name);

/// A model whose kinematics deviate from the nominal ones like those of an arm that was calibrated in the
/// factory. `seed` selects the arm.
RobotModel with_random_calibration(RobotModel model, std::uint64_t seed);

/// Default joint position after power-on, which the documentation and the examples use as well: the tool
/// points down, away from singularities, and nothing is exact, as on a robot.
Vector6 default_position(const RobotModel & model);

}  // namespace ur_simulator
