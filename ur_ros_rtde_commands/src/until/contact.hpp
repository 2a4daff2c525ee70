#pragma once

#include <array>
#include <functional>
#include <geometry_msgs/msg/twist.hpp>
#include <geometry_msgs/msg/vector3.hpp>
#include <optional>
#include <ur_ros_rtde_msgs/msg/arm_state.hpp>
#include <vector>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde {

/// The PolyScope 5 that brought tool_contact (UR, Script Manual); there is none on a CB3.
constexpr unsigned contact_polyscope = 4;

/// For directions, whose length does not matter.
constexpr double any_length = 1e9;
Check & check_direction(Check & check, const geometry_msgs::msg::Twist & direction);

/// Control cycles since the tool began to touch something in `direction` (UR's twist in the base frame; only
/// the linear part counts, zero: any direction); 0: it touches nothing. Throws RobotError when the control
/// program cannot answer now.
int contact_steps(Run & run, const std::vector<double> & direction);

/// A motion until the controller detects a contact, in its own terms: m, s, m/s^2.
struct ContactMotion {
  geometry_msgs::msg::Twist twist;
  geometry_msgs::msg::Vector3 direction;  ///< zero: that of twist.linear
  double acceleration;
  double timeout;
  double distance;
  bool retract;
};

/// Runs the motion in the controller, by a program in the place of the control program (hold
/// Resource::script): it looks at the contact in each control cycle. `found` is told where the contact began,
/// if there is one. not_reached when there is none on the way, timeout when the time is over.
Outcome move_until_contact(Run & run, const ContactMotion & motion,
                           const std::function<void(const ur_ros_rtde_msgs::msg::ArmState &)> & found);

}  // namespace ur_ros_rtde
