#pragma once

#include <cstdint>
#include <random>

#include "common/types.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// The force/torque sensor at the flange and what the controller makes of it: noise, weight and inertia of
/// the load, low-pass filter, compensation of the payload it was told, zero offset.
class ForceTorqueSensor {
 public:
  ForceTorqueSensor(double cycle_time, std::uint64_t seed);

  void zero() { zero_requested_ = true; }
  void set_noise(double force, double torque);
  /// From state.contact_wrench and the true load: writes ft_raw_wrench and actual_tcp_force.
  void step(const Payload & load, ControllerState & state);
  /// Reading without the zero offset, in base axes: what a change of force shows in.
  Vector3 force() const { return force_; }

 private:
  Vector6 noise();
  static Vector6 measured(const ControllerState & state);

  double filter_gain_;
  double force_noise_ = 0.5;
  double torque_noise_ = 0.02;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  Vector6 filtered_ = Vector6::Zero();
  Vector6 offset_ = Vector6::Zero();
  Vector3 force_ = Vector3::Zero();
  bool first_ = true;
  bool zero_requested_ = false;
};

}  // namespace ur_simulator
