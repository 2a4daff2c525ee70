#pragma once

#include "ur_ros_rtde_trajectory/limits.hpp"

namespace ur_ros_rtde {

/// The parameters of servoJ.
struct ServoParameters {
  double lookahead_time = 0.1;  ///< s, 0.03 to 0.2
  double gain = 600.0;          ///< 1/s^2, 100 to 2000
};

/// A joint motion at one moment: rad, rad/s, rad/s^2.
struct JointMotion {
  trajectory::Joints position, velocity, acceleration;
};

/// The setpoint of servoJ with which the arm follows `desired` without delay. By the script manual, servoj
/// projects the position forward by lookahead_time and corrects the rest with the gain:
///
///     q'' = gain (setpoint - q - lookahead_time q')
///
/// A constant velocity would therefore be followed lookahead_time late; measured on a UR10e at 0.03 s: 30 ms
/// (Universal_Robots_Client_Library, issue 86). This function solves the equation for the setpoint, which is
/// the end of the motion at rest, and is kept within the position range of `limits`.
trajectory::Joints servo_setpoint(const JointMotion & desired, const ServoParameters & servo,
                                  const trajectory::Limits & limits);

}  // namespace ur_ros_rtde
