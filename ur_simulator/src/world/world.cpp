#include "world/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/pose.hpp"
#include "world/contact_forces.hpp"
#include "world/requirements.hpp"

namespace ur_simulator {
namespace {

using std::numbers::pi;

}  // namespace

World::World(const RobotModel & model, std::uint64_t seed)
    : cycle_time_(model.cycle_time()), sensor_(model, seed), contact_detector_(cycle_time_)
{
  pushes_.reserve(max_pushes);
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
  const auto add = [&](const auto & objects) {
    for (const auto & [id, object] : objects) {
      wrench.head<3>() += contact_force(object, state);
    }
  };
  add(surfaces_);
  add(boxes_);
  add(springs_);
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
