#include "world/contact_forces.hpp"

#include <algorithm>

#include "common/pose.hpp"

namespace ur_simulator {
namespace {

/// Share of a deflection along `direction` that the object takes, beside the joints of the arm.
double object_share(double stiffness, const Vector3 & direction, const ControllerState & state)
{
  return 1.0 / (1.0 + stiffness * direction.dot(state.tcp_compliance * direction));
}

}  // namespace

/// Spring and damper along the normal, never pulling; Coulomb friction in the plane, regularized at low
/// speed.
Vector3 contact_force(const Surface & surface, const ControllerState & state)
{
  const Elasticity & elasticity = surface.elasticity;
  const Vector3 velocity = state.actual_tcp_speed.head<3>();
  const double penetration = -surface.normal.dot(state.actual_tcp_pose.head<3>() - surface.point);
  if (penetration <= 0.0) {
    return Vector3::Zero();
  }
  const double approach = -surface.normal.dot(velocity);
  const double normal_force =
      object_share(elasticity.stiffness, surface.normal, state) *
      std::max(0.0, elasticity.stiffness * penetration + elasticity.damping * approach);
  const Vector3 sliding = velocity + approach * surface.normal;
  constexpr double full_friction_speed = 1e-3;  // m/s
  return normal_force * surface.normal -
         elasticity.friction * normal_force / std::max(sliding.norm(), full_friction_speed) * sliding;
}

Vector3 contact_force(const Box & box, const ControllerState & state)
{
  const Eigen::Matrix3d axes = to_rotation_matrix(box.rotation);
  const Vector3 position = axes.transpose() * (state.actual_tcp_pose.head<3>() - box.center);
  const Vector3 depth = 0.5 * box.size - position.cwiseAbs();
  Eigen::Index face = 0;
  if (depth.minCoeff(&face) <= 0.0) {
    return Vector3::Zero();
  }
  const Vector3 normal = (position[face] < 0.0 ? -1.0 : 1.0) * axes.col(face);
  return contact_force(Surface{box.center + 0.5 * box.size[face] * normal, normal, box.elasticity}, state);
}

Vector3 contact_force(const Spring & spring, const ControllerState & state)
{
  const Vector3 extent = state.actual_tcp_pose.head<3>() - spring.anchor;
  const double distance = extent.norm();
  if (distance < 1e-9) {
    return Vector3::Zero();
  }
  const Vector3 direction = extent / distance;
  const double speed = direction.dot(state.actual_tcp_speed.head<3>());
  return -object_share(spring.stiffness, direction, state) *
         (spring.stiffness * (distance - spring.length) + spring.damping * speed) * direction;
}

}  // namespace ur_simulator
