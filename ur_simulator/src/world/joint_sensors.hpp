#pragma once

#include <cstdint>
#include <random>

#include "kinematics/robot_model.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// The encoders and current sensors of the joints and the accelerometer in the flange, with the resolution
/// and noise of recordings of robots (docs/internals/compared_with_robots.md). Deterministic for a given
/// seed.
class JointSensors {
 public:
  /// `model` must outlive this object.
  JointSensors(const RobotModel & model, std::uint64_t seed);
  /// Adds noise to state.measured while the arm has power.
  void step(ControllerState & state);

 private:
  Vector6 noise();

  const RobotModel & model_;
  Vector6 current_noise_;  ///< A
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

}  // namespace ur_simulator
