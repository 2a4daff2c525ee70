#include "world/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "common/pose.hpp"

namespace ur_simulator {
namespace {

using std::numbers::pi;

void require(bool condition, const std::string & message)
{
  if (!condition) {
    throw std::invalid_argument(message);
  }
}

void require_within(const char * field, double value, double min, double max)
{
  require(value >= min && value <= max, fmt::format("{} must be in [{}, {}], is {}", field, min, max, value));
}

Surface checked(const Surface & surface)
{
  require(is_finite(surface.point), "surface: point must be three finite numbers");
  require(is_finite(surface.normal) && surface.normal.norm() > 1e-9,
          "surface: normal must be three finite numbers, not all 0");
  require_within("surface: stiffness (N/m)", surface.stiffness, 0.0, 1e7);
  require_within("surface: damping (N s/m)", surface.damping, 0.0, 1e5);
  require_within("surface: friction", surface.friction, 0.0, 10.0);
  Surface result = surface;
  result.normal.normalize();
  return result;
}

/// Spring and damper along the normal, never pulling; Coulomb friction in the plane, regularized at low
/// speed. The elasticity of the arm is in series with the surface: `state` holds the TCP of a rigid arm, and
/// the penetration is shared between arm and surface.
Vector3 surface_force(const Surface & surface, const ControllerState & state)
{
  const Vector3 velocity = state.actual_tcp_speed.head<3>();
  const double penetration = -surface.normal.dot(state.actual_tcp_pose.head<3>() - surface.point);
  if (penetration <= 0.0) {
    return Vector3::Zero();
  }
  const double approach = -surface.normal.dot(velocity);
  const double surface_share =
      1.0 / (1.0 + surface.stiffness * surface.normal.dot(state.tcp_compliance * surface.normal));
  const double normal_force =
      surface_share * std::max(0.0, surface.stiffness * penetration + surface.damping * approach);
  const Vector3 sliding = velocity + approach * surface.normal;
  constexpr double full_friction_speed = 1e-3;  // m/s
  return normal_force * surface.normal -
         surface.friction * normal_force / std::max(sliding.norm(), full_friction_speed) * sliding;
}

}  // namespace

World::World(double cycle_time, std::uint64_t seed)
    : cycle_time_(cycle_time), sensor_(cycle_time, seed), contact_detector_(cycle_time)
{
  surfaces_.reserve(max_surfaces);
  pushes_.reserve(max_pushes);
}

std::uint32_t World::place_surface(const Surface & surface)
{
  require(surfaces_.size() < max_surfaces,
          fmt::format("surface: there are {} already, the maximum", max_surfaces));
  surfaces_.push_back({next_id_, checked(surface)});
  return next_id_++;
}

bool World::remove_surface(std::uint32_t id)
{
  return std::erase_if(surfaces_, [id](const PlacedSurface & placed) { return placed.id == id; }) > 0;
}

void World::clear_surfaces()
{
  surfaces_.clear();
}

void World::push(const Push & push)
{
  require(pushes_.size() < max_pushes, fmt::format("push: {} are active already, the maximum", max_pushes));
  require(is_finite(push.wrench), "push: wrench must be six finite numbers");
  require_within("push: force (N)", push.wrench.head<3>().norm(), 0.0, 1e4);
  require_within("push: torque (N m)", push.wrench.tail<3>().norm(), 0.0, 1e4);
  require_within("push: duration (s)", push.duration, cycle_time_, 3600.0);
  pushes_.push_back({push});
}

void World::clear_pushes()
{
  pushes_.clear();
}

void World::attach_load(const Payload & load)
{
  require_within("load: mass (kg)", load.mass, 0.0, 1000.0);
  require(is_finite(load.center_of_gravity) && load.center_of_gravity.norm() <= 10.0,
          "load: center of gravity must be three finite numbers, at most 10 m from the flange");
  require(is_finite(load.inertia), "load: inertia must be six finite numbers");
  load_ = load;
}

void World::zero_sensor()
{
  sensor_.zero();
}

void World::set_sensor_noise(double force, double torque)
{
  require_within("sensor noise: force (N)", force, 0.0, 1000.0);
  require_within("sensor noise: torque (N m)", torque, 0.0, 1000.0);
  sensor_.set_noise(force, torque);
}

Vector6 World::contact(const ControllerState & state) const
{
  Vector6 wrench = Vector6::Zero();
  for (const PlacedSurface & placed : surfaces_) {
    wrench.head<3>() += surface_force(placed.surface, state);
  }
  return wrench;
}

Vector6 World::advance_pushes(const ControllerState & state)
{
  Vector6 sum = Vector6::Zero();
  for (ActivePush & active : pushes_) {
    active.elapsed += cycle_time_;
    const double phase = std::min(1.0, active.elapsed / active.push.duration);
    const Vector6 wrench = std::sin(pi * phase) * active.push.wrench;
    sum += active.push.tool_frame
               ? rotate_spatial_vector(to_rotation_matrix(state.actual_tcp_pose.tail<3>()), wrench)
               : wrench;
  }
  std::erase_if(pushes_, [](const ActivePush & active) { return active.elapsed >= active.push.duration; });
  return sum;
}

void World::step(ControllerState & state)
{
  state.contact_wrench = contact(state) + advance_pushes(state);
  sensor_.step(load_, state);
  if (gripper_) {
    gripper_->step(cycle_time_);
  }
  if (robotiq_gripper_) {
    robotiq_gripper_->step(cycle_time_, state.is_powered());
  }
  if (digital_gripper_) {
    digital_gripper_->step(cycle_time_, state.io);
  }
  contact_detector_.record(sensor_.force(), state);
}

}  // namespace ur_simulator
