#include "dynamics/dynamics.hpp"

#include <array>

#include "kinematics/forward_kinematics.hpp"

namespace ur_simulator {
namespace {

using Frames = std::array<Transform, 6>;

/// m (|r|^2 1 - r r'): the term of the parallel axis theorem for a mass at r.
Eigen::Matrix3d parallel_axis_inertia(double mass, const Vector3 & r)
{
  return mass * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
}

Link with_payload(const Link & link, const Payload & payload)
{
  Link body = link;
  body.mass = link.mass + payload.mass;
  if (body.mass <= 0.0) {
    return link;
  }
  body.center_of_mass =
      (link.mass * link.center_of_mass + payload.mass * payload.center_of_gravity) / body.mass;
  const auto & i = payload.inertia;
  Eigen::Matrix3d own;
  own << i[0], i[3], i[4],  //
      i[3], i[1], i[5],     //
      i[4], i[5], i[2];
  body.inertia = link.inertia + parallel_axis_inertia(link.mass, link.center_of_mass - body.center_of_mass) +
                 own + parallel_axis_inertia(payload.mass, payload.center_of_gravity - body.center_of_mass);
  return body;
}

}  // namespace

Dynamics::Dynamics(const RobotModel & model) : model_(model), links_(model.links) {}

void Dynamics::set_payload(const Payload & payload)
{
  links_[5] = with_payload(model_.links[5], payload);
}

void Dynamics::set_gravity(const Vector3 & gravity)
{
  gravity_ = gravity;
}

Vector6 Dynamics::inverse_dynamics(const Vector6 & q, const Vector6 & qd, const Vector6 & qdd) const
{
  return newton_euler(link_frames(model_, q), qd, qdd, gravity_);
}

Vector6 Dynamics::inverse_dynamics(const Frames & frames, const Vector6 & qd, const Vector6 & qdd,
                                   Vector6 * base_wrench) const
{
  return newton_euler(frames, qd, qdd, gravity_, base_wrench);
}

Vector6 Dynamics::gravity_torques(const Vector6 & q) const
{
  return newton_euler(link_frames(model_, q), Vector6::Zero(), Vector6::Zero(), gravity_);
}

Vector6 Dynamics::coriolis_torques(const Vector6 & q, const Vector6 & qd) const
{
  return newton_euler(link_frames(model_, q), qd, Vector6::Zero(), Vector3::Zero());
}

Matrix6 Dynamics::mass_matrix(const Vector6 & q) const
{
  const Frames frames = link_frames(model_, q);
  Matrix6 result;
  for (Eigen::Index i = 0; i < 6; ++i) {
    result.col(i) = newton_euler(frames, Vector6::Zero(), Vector6::Unit(i), Vector3::Zero());
  }
  return 0.5 * (result + result.transpose());
}

double Dynamics::kinetic_energy(const Vector6 & q, const Vector6 & qd) const
{
  return 0.5 * qd.dot(mass_matrix(q) * qd);
}

double Dynamics::potential_energy(const Vector6 & q) const
{
  const Frames frames = link_frames(model_, q);
  double energy = 0.0;
  for (std::size_t i = 0; i < 6; ++i) {
    energy += links_[i].mass * gravity_.dot(frames[i] * links_[i].center_of_mass);
  }
  return energy;
}

Vector6 Dynamics::currents(const Vector6 & torques) const
{
  return torques.cwiseQuotient(model_.torque_constant);
}

Vector6 Dynamics::newton_euler(const Frames & frames, const Vector6 & qd, const Vector6 & qdd,
                               const Vector3 & gravity, Vector6 * base_wrench) const
{
  // All quantities in the base frame. Outward recursion: motion of each link, and the force and the moment
  // about its center of mass that accelerate it.
  std::array<Vector3, 6> axis, origin, force, moment, center;
  Vector3 angular = Vector3::Zero(), angular_acceleration = Vector3::Zero(), acceleration = gravity;
  Vector3 previous_axis = Vector3::UnitZ(), previous_origin = Vector3::Zero();
  for (std::size_t i = 0; i < 6; ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    axis[i] = previous_axis;
    origin[i] = previous_origin;
    angular_acceleration += qdd[joint] * axis[i] + angular.cross(Vector3(qd[joint] * axis[i]));
    angular += qd[joint] * axis[i];
    const auto relative_acceleration = [&](const Vector3 & arm) -> Vector3 {
      return angular_acceleration.cross(arm) + angular.cross(Vector3(angular.cross(arm)));
    };
    const auto & rotation = frames[i].linear();
    center[i] = frames[i] * links_[i].center_of_mass;
    const Vector3 center_acceleration = acceleration + relative_acceleration(center[i] - origin[i]);
    const Eigen::Matrix3d inertia = rotation * links_[i].inertia * rotation.transpose();
    force[i] = links_[i].mass * center_acceleration;
    moment[i] = inertia * angular_acceleration + angular.cross(Vector3(inertia * angular));
    acceleration += relative_acceleration(frames[i].translation() - origin[i]);
    previous_axis = rotation.col(2);
    previous_origin = frames[i].translation();
  }
  // Inward recursion: the torque of each joint from the forces on all links beyond it.
  Vector6 torques;
  Vector3 total_force = Vector3::Zero(), total_moment = Vector3::Zero(), point = previous_origin;
  for (std::size_t i = 6; i-- > 0;) {
    total_moment +=
        (point - origin[i]).cross(total_force) + (center[i] - origin[i]).cross(force[i]) + moment[i];
    total_force += force[i];
    point = origin[i];
    torques[static_cast<Eigen::Index>(i)] = axis[i].dot(total_moment);
  }
  if (base_wrench != nullptr) {
    *base_wrench << total_force, total_moment;
  }
  return torques;
}

}  // namespace ur_simulator
