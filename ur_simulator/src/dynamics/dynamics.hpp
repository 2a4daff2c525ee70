#pragma once

#include <array>

#include "common/types.hpp"
#include "kinematics/robot_model.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// Rigid-body dynamics of an arm with a payload at the flange, by the recursive Newton-Euler algorithm (Luh,
/// Walker, Paul 1980) in DH frames. Torques in N m at the joints, after the gears. `gravity` is defined as in
/// URScript's set_gravity(): the upward acceleration, (0, 0, 9.82) for an upright arm.
class Dynamics {
 public:
  explicit Dynamics(const RobotModel & model);

  void set_payload(const Payload & payload);
  void set_gravity(const Vector3 & gravity);

  /// tau = M(q) qdd + C(q, qd) qd + g(q)
  Vector6 inverse_dynamics(const Vector6 & q, const Vector6 & qd, const Vector6 & qdd) const;
  /// The same from the frames of link_frames(). If `base_wrench` is not null, it is set to the wrench that
  /// the base exerts on the arm: force, and moment about the origin of the base frame.
  Vector6 inverse_dynamics(const std::array<Transform, 6> & frames, const Vector6 & qd, const Vector6 & qdd,
                           Vector6 * base_wrench = nullptr) const;
  Vector6 gravity_torques(const Vector6 & q) const;
  Matrix6 mass_matrix(const Vector6 & q) const;
  /// C(q, qd) qd, as URScript's get_coriolis_and_centrifugal_torques().
  Vector6 coriolis_torques(const Vector6 & q, const Vector6 & qd) const;
  /// 1/2 qd' M qd and the gravitational energy, J.
  double kinetic_energy(const Vector6 & q, const Vector6 & qd) const;
  double potential_energy(const Vector6 & q) const;
  /// Motor current (A) for joint torques: torque / torque_constant.
  Vector6 currents(const Vector6 & torques) const;

 private:
  Vector6 newton_euler(const std::array<Transform, 6> & frames, const Vector6 & qd, const Vector6 & qdd,
                       const Vector3 & gravity, Vector6 * base_wrench = nullptr) const;

  const RobotModel & model_;
  std::array<Link, 6> links_;  ///< the last one includes the payload
  Vector3 gravity_ = Vector3(0.0, 0.0, 9.82);
};

}  // namespace ur_simulator
