#include "world/sensor.hpp"

#include <cmath>
#include <numbers>

#include "common/pose.hpp"

namespace ur_simulator {
namespace {

constexpr double cut_off = 50.0;  // Hz, of the low-pass filter
using std::numbers::pi;

/// What a load does to the flange when the flange is accelerated: `specific_force` is what an accelerometer
/// there reads, so that standing still means the load's weight. All in flange axes, about the flange's
/// origin.
Vector6 load_wrench(const Payload & load, const Vector3 & specific_force)
{
  const Vector3 force = -load.mass * specific_force;
  Vector6 wrench;
  wrench << force, load.center_of_gravity.cross(force);
  return wrench;
}

}  // namespace

ForceTorqueSensor::ForceTorqueSensor(double cycle_time, std::uint64_t seed)
    : filter_gain_(1.0 - std::exp(-2.0 * pi * cut_off * cycle_time)), random_(seed)
{
}

void ForceTorqueSensor::set_noise(double force, double torque)
{
  force_noise_ = force;
  torque_noise_ = torque;
}

Vector6 ForceTorqueSensor::noise()
{
  Vector6 result;
  for (Eigen::Index i = 0; i < 6; ++i) {
    result[i] = (i < 3 ? force_noise_ : torque_noise_) * normal_(random_);
  }
  return result;
}

Vector6 ForceTorqueSensor::measured(const ControllerState & state)
{
  const ExternalSensor & external = state.external_sensor;
  if (!external.enabled) {
    return state.ft_raw_wrench;
  }
  // It feels what hangs below it: of the payload, all but itself.
  const Payload itself{external.mass, external.center_of_gravity, Vector6::Zero()};
  return shift_wrench(state.external_force_torque, external.measuring_offset) +
         load_wrench(itself, state.tool_acceleration);
}

void ForceTorqueSensor::step(const Payload & load, ControllerState & state)
{
  const Transform tcp = to_transform(state.actual_tcp_pose);
  const Transform flange = tcp * to_transform(state.tcp_offset).inverse();
  const Eigen::Matrix3d & to_base = flange.linear();
  const Vector3 lever = tcp.translation() - flange.translation();

  const Vector6 contact = rotate_pair(to_base.transpose(), shift_wrench(state.contact_wrench, lever));
  state.ft_raw_wrench = contact + load_wrench(load, state.tool_acceleration) + noise();

  const Vector3 upward = to_base.transpose() * state.gravity;
  const Vector6 unknown = load_wrench(load, upward) - load_wrench(state.payload, upward);
  state.tool_wrench = state.contact_wrench + shift_wrench(rotate_pair(to_base, unknown), -lever);

  const Vector6 compensated = measured(state) - load_wrench(state.payload, state.tool_acceleration);
  filtered_ = first_ ? compensated : Vector6(filtered_ + filter_gain_ * (compensated - filtered_));
  first_ = false;
  if (zero_requested_) {
    offset_ = filtered_;
    zero_requested_ = false;
  }
  force_ = to_base * filtered_.head<3>();
  state.actual_tcp_force = shift_wrench(rotate_pair(to_base, filtered_ - offset_), -lever);
}

}  // namespace ur_simulator
