#pragma once

#include <cstdint>
#include <random>

#include "common/types.hpp"
#include "kinematics/robot_model.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// Whether get_tcp_force() and RTDE report the wrench at the flange instead of the TCP, as an e-Series
/// without an external sensor does (Universal_Robots_ROS2_Driver, pull request 1287 and issue 1849).
bool reports_force_at_flange(const RobotModel & model, const ControllerState & state);

/// The force/torque sensor at the flange and its signal processing in the controller: noise, weight and
/// inertia of the load, low-pass filter, payload compensation, zero offset.
class ForceTorqueSensor {
 public:
  /// `model` must outlive this object.
  ForceTorqueSensor(const RobotModel & model, std::uint64_t seed);

  void zero() { zero_requested_ = true; }
  /// The controller zeroes its sensor when a program starts (Universal_Robots_ROS_Driver, issues 512 and
  /// 643).
  void begin_program();
  void set_noise(double force, double torque);
  /// Computes ft_raw_wrench, tool_wrench and actual_tcp_force from state.contact_wrench and the true load.
  void step(const Payload & load, ControllerState & state);
  /// Filtered force without the zero offset, in the base frame.
  Vector3 force() const { return force_; }

 private:
  Vector6 noise();
  static Vector6 sensor_wrench(const ControllerState & state);

  double filter_gain_;
  const RobotModel & model_;
  std::mt19937_64 random_;
  double force_noise_;
  double torque_noise_;
  std::normal_distribution<double> normal_;
  Vector6 filtered_ = Vector6::Zero();
  Vector6 offset_ = Vector6::Zero();
  Vector3 force_ = Vector3::Zero();
  bool first_cycle_ = true;
  bool zero_requested_ = false;
};

}  // namespace ur_simulator
