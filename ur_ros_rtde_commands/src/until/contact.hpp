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

/// tool_contact exists since PolyScope 5.4 (UR, Script Manual), and not on a CB3.
constexpr unsigned min_contact_polyscope = 4;

/// The limit for directions, whose length does not matter.
constexpr double any_length = 1e9;
Check & check_direction(Check & check, const geometry_msgs::msg::Twist & direction);

/// The number of control cycles since the contact of the tool in `direction` began, 0 without contact.
/// `direction` is a UR twist in the base frame; only its linear part is used, zero for any direction. Throws
/// RobotError if the control program cannot answer now.
int contact_steps(Run & run, const std::vector<double> & direction);

/// A motion until the controller detects a contact, in m, s, m/s^2.
struct ContactMotion {
  geometry_msgs::msg::Twist twist;
  geometry_msgs::msg::Vector3 direction;  ///< zero: the direction of twist.linear
  double acceleration;
  double timeout;
  double distance;
  bool retract;
};

/// Executes the motion with a script that replaces the control program (requires Resource::script) and checks
/// for contact in each control cycle. Calls `on_contact` with the state in which the contact began. Fails
/// with not_reached if there is no contact within `distance`, and with timeout if there is none within
/// `timeout`.
Outcome move_until_contact(Run & run, const ContactMotion & motion,
                           const std::function<void(const ur_ros_rtde_msgs::msg::ArmState &)> & on_contact);

}  // namespace ur_ros_rtde
