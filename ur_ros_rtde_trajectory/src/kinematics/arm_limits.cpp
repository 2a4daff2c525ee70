#include "ur_ros_rtde_trajectory/arm_limits.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <numbers>
#include <string_view>

namespace ur_ros_rtde {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double full_turn = 2.0 * std::numbers::pi;
constexpr Vector6 two_turns{full_turn, full_turn, full_turn, full_turn, full_turn, full_turn};

constexpr Vector6 degrees(double base, double shoulder, double elbow, double wrist_1, double wrist_2,
                          double wrist_3)
{
  return {base * degree,    shoulder * degree, elbow * degree,
          wrist_1 * degree, wrist_2 * degree,  wrist_3 * degree};
}

struct Model {
  std::string_view name;
  ArmLimits limits;
};

// Nm. "Max. joint torques" in UR's user manuals.
constexpr Vector6 ur3_torques{56.0, 56.0, 28.0, 12.0, 12.0, 12.0};
constexpr Vector6 ur3e_torques{54.0, 54.0, 28.0, 9.0, 9.0, 9.0};
constexpr Vector6 ur5_torques{150.0, 150.0, 150.0, 28.0, 28.0, 28.0};
constexpr Vector6 ur10_torques{330.0, 330.0, 150.0, 56.0, 56.0, 56.0};
constexpr Vector6 ur10e_torques{330.0, 330.0, 150.0, 54.0, 54.0, 54.0};
constexpr Vector6 ur15_torques{433.0, 433.0, 204.0, 70.0, 70.0, 70.0};
constexpr Vector6 ur20_torques{738.0, 738.0, 433.0, 107.0, 107.0, 107.0};

// Universal Robots' technical specifications of the arms (working range, joint speeds, reach).
constexpr std::array models{
    Model{"ur3", {two_turns, degrees(180, 180, 180, 360, 360, 360), ur3_torques, 0.5}},
    Model{"ur5", {two_turns, degrees(180, 180, 180, 180, 180, 180), ur5_torques, 0.85}},
    Model{"ur10", {two_turns, degrees(120, 120, 180, 180, 180, 180), ur10_torques, 1.3}},
    Model{"ur3e", {two_turns, degrees(180, 180, 180, 360, 360, 360), ur3e_torques, 0.5}},
    Model{"ur5e", {two_turns, degrees(180, 180, 180, 180, 180, 180), ur5_torques, 0.85}},
    Model{"ur7e", {two_turns, degrees(180, 180, 180, 180, 180, 180), ur5_torques, 0.85}},
    Model{"ur10e", {two_turns, degrees(120, 120, 180, 180, 180, 180), ur10e_torques, 1.3}},
    Model{"ur12e", {two_turns, degrees(120, 120, 180, 180, 180, 180), ur10e_torques, 1.3}},
    Model{"ur16e", {two_turns, degrees(120, 120, 180, 180, 180, 180), ur10e_torques, 0.9}},
    Model{"ur8long", {two_turns, degrees(180, 180, 240, 300, 300, 300), ur15_torques, 1.75}},
    Model{"ur15", {two_turns, degrees(180, 180, 240, 300, 300, 300), ur15_torques, 1.3}},
    Model{"ur18", {two_turns, degrees(180, 180, 240, 300, 300, 300), ur15_torques, 0.95}},
    Model{"ur20", {two_turns, degrees(120, 120, 150, 210, 210, 210), ur20_torques, 1.75}},
    Model{"ur30", {two_turns, degrees(120, 120, 150, 210, 210, 210), ur20_torques, 1.3}},
};

}  // namespace

std::string normalized_model_name(const std::string & name)
{
  std::string key;
  for (const char c : name) {
    if (c != ' ' && c != '-' && c != '_') {
      key.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
    }
  }
  return key;
}

std::optional<ArmLimits> arm_limits(const std::string & model)
{
  const std::string name = normalized_model_name(model);
  const auto found =
      std::find_if(models.begin(), models.end(), [&](const Model & m) { return m.name == name; });
  return found == models.end() ? std::nullopt : std::optional(found->limits);
}

std::string arm_models()
{
  std::string names;
  for (const Model & model : models) {
    names += (names.empty() ? "" : ", ") + std::string(model.name);
  }
  return names;
}

ArmLimits common_arm_limits()
{
  ArmLimits common = widest_arm_limits();
  for (const Model & model : models) {
    for (std::size_t joint = 0; joint < common.velocity.size(); ++joint) {
      common.velocity[joint] = std::min(common.velocity[joint], model.limits.velocity[joint]);
      common.torque[joint] = std::min(common.torque[joint], model.limits.torque[joint]);
    }
  }
  return common;
}

ArmLimits widest_arm_limits()
{
  return {two_turns, degrees(360, 360, 360, 360, 360, 360), ur20_torques, 1.75};
}

}  // namespace ur_ros_rtde
