#include "world/joint_sensors.hpp"

#include <numbers>

#include "kinematics/forward_kinematics.hpp"

namespace ur_simulator {
namespace {

constexpr double encoder_step = 2.0 * std::numbers::pi / (1 << 19);  // rad: positions are multiples of it
constexpr double position_noise = 1.7e-5;                            // rad
constexpr double acceleration_noise = 0.05;                          // m/s^2 (e-Series)

/// The currents of larger joints are noisier: 27 mA of 150 N m and 7 mA of 28 N m (UR5e), 11 to 27 mA and 9
/// mA (UR5).
Vector6 current_noise(const RobotModel & model)
{
  const bool cb3 = model.series == Series::cb3;
  return ((cb3 ? 0.7e-4 : 1.7e-4) * model.torque_max.array() + (cb3 ? 6e-3 : 2e-3)).matrix();
}

}  // namespace

JointSensors::JointSensors(const RobotModel & model, std::uint64_t seed)
    : model_(model), current_noise_(current_noise(model)), random_(seed)
{
}

void JointSensors::step(ControllerState & state)
{
  if (!state.is_powered()) {
    return;
  }
  const Vector6 position = state.actual.position + position_noise * noise();
  state.measured.position = (position / encoder_step).array().round().matrix() * encoder_step;
  state.measured.current = state.actual.current + current_noise_.cwiseProduct(noise());
  state.measured.tool_acceleration = state.tool_acceleration + acceleration_noise * noise().head<3>();
  state.measured.tcp_pose = tcp_pose(model_, state.measured.position, state.tcp_offset);
}

Vector6 JointSensors::noise()
{
  Vector6 result;
  for (double & value : result) {
    value = normal_(random_);
  }
  return result;
}

}  // namespace ur_simulator
