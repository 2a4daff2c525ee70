// Prints, for every model of the simulator, as JSON: names and limits; and for random joint positions the
// pose of the flange, as simulator and driver calculate it, the masses of the links, and the cylinders of the
// collision detection.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <stdexcept>

#include "kinematics/forward_kinematics.hpp"
#include "kinematics/link_shapes.hpp"
#include "kinematics/robot_model.hpp"
#include "ur_ros_rtde_trajectory/arm.hpp"
#include "ur_ros_rtde_trajectory/arm_limits.hpp"

namespace {

using nlohmann::json;
using ur_simulator::RobotModel;
using ur_simulator::Vector6;

constexpr int sample_count = 50;

template <class Derived>
json to_json(const Eigen::DenseBase<Derived> & values)
{
  json result = json::array();
  for (const auto row : values.rowwise()) {
    for (const double value : row) {
      result.push_back(std::isfinite(value) ? json(value) : json());
    }
  }
  return result;
}

/// Mass, center of mass and inertia of each link in the base frame.
json masses_of(const RobotModel & model, const std::array<ur_simulator::Transform, 6> & frames)
{
  json result = json::array();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const ur_simulator::Link & link = model.links[i];
    const Eigen::Matrix3d rotation = frames[i].linear();
    result.push_back({{"mass", link.mass},
                      {"center", to_json(frames[i] * link.center_of_mass)},
                      {"inertia", to_json(rotation * link.inertia * rotation.transpose())}});
  }
  return result;
}

/// Axis and radius of the cylinders of each body in the base frame, by the number of the body.
json cylinders_of(const RobotModel & model, const std::array<ur_simulator::Transform, 6> & frames)
{
  json result = json::array();
  for (const ur_simulator::LinkCylinder & cylinder : ur_simulator::link_cylinders(model)) {
    const auto placed = ur_simulator::in_base_frame({cylinder.body, cylinder.axis, cylinder.radius}, frames);
    result.push_back({{"body", static_cast<int>(cylinder.body)},
                      {"begin", to_json(placed.axis.begin)},
                      {"end", to_json(placed.axis.end)},
                      {"radius", placed.radius}});
  }
  return result;
}

/// The arm of the trajectory library whose kinematics are nearest to those of the model.
ur_ros_rtde::kinematics::Arm driver_arm(const RobotModel & model)
{
  const Vector6 joints = ur_simulator::default_position(model);
  const ur_ros_rtde::kinematics::Pose flange(ur_simulator::flange_pose(model, joints).matrix());
  auto arm = ur_ros_rtde::kinematics::identify_arm(joints.array(), flange,
                                                   ur_ros_rtde::kinematics::Pose::Identity());
  if (!arm) {
    throw std::runtime_error(fmt::format("{}: {}", model.name, arm.error().message));
  }
  return *arm;
}

json samples_of(const RobotModel & model, std::mt19937 & random)
{
  std::uniform_real_distribution<double> angle(-2.0 * std::numbers::pi, 2.0 * std::numbers::pi);
  const auto arm = driver_arm(model);
  json result = json::array();
  for (int i = 0; i < sample_count; ++i) {
    const Vector6 joints = Vector6::NullaryExpr([&] { return angle(random); });
    const auto frames = ur_simulator::link_frames(model, joints);
    result.push_back({{"joints", to_json(joints)},
                      {"simulator", to_json(frames[5].matrix())},
                      {"driver", to_json(arm.forward(joints.array()).matrix())},
                      {"masses", masses_of(model, frames)},
                      {"cylinders", cylinders_of(model, frames)}});
  }
  return result;
}

json driver_limits(const RobotModel & model)
{
  const auto limits = ur_ros_rtde::arm_limits(model.name);
  if (!limits) {
    throw std::runtime_error(fmt::format("{}: the trajectory library has no limits", model.name));
  }
  return {{"position", limits->position}, {"velocity", limits->velocity}, {"torque", limits->torque}};
}

}  // namespace

int main()
{
  std::mt19937 random(1);
  json models;
  for (const RobotModel & model : ur_simulator::robot_models()) {
    models[model.name] = {
        {"display_name", model.display_name},          {"position_max", to_json(model.position_max)},
        {"velocity_max", to_json(model.velocity_max)}, {"torque_max", to_json(model.torque_max)},
        {"driver_limits", driver_limits(model)},       {"samples", samples_of(model, random)}};
  }
  std::cout << models << '\n';
}
