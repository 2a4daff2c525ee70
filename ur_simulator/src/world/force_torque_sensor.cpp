#include "world/force_torque_sensor.hpp"

#include <cmath>
#include <numbers>

#include "common/pose.hpp"

namespace ur_simulator {
namespace {

constexpr double cutoff_frequency = 50.0;  // Hz, of the low-pass filter
using std::numbers::pi;

/// Wrench of a load on the flange. `specific_force` is the reading of an accelerometer at the flange; at
/// standstill the result is the weight of the load. All in the flange frame.
Vector6 load_wrench(const Payload & load, const Vector3 & specific_force)
{
  const Vector3 force = -load.mass * specific_force;
  Vector6 wrench;
  wrench << force, load.center_of_gravity.cross(force);
  return wrench;
}

}  // namespace

bool reports_force_at_flange(const RobotModel & model, const ControllerState & state)
{
  return model.series != Series::cb3 && !state.external_sensor.enabled;
}

/// Noise before the filter, so that the filtered readings have that of recordings: 0.15 N and 5 mN m
/// (e-Series), 0.55 N and 0.11 N m (CB3).
ForceTorqueSensor::ForceTorqueSensor(const RobotModel & model, std::uint64_t seed)
    : filter_gain_(1.0 - std::exp(-2.0 * pi * cutoff_frequency * model.cycle_time())),
      model_(model),
      random_(seed),
      force_noise_(model.has_force_torque_sensor() ? 0.3 : 0.6),
      torque_noise_(model.has_force_torque_sensor() ? 0.009 : 0.12)
{
}

void ForceTorqueSensor::begin_program()
{
  if (model_.has_force_torque_sensor()) {
    zero();
  }
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

Vector6 ForceTorqueSensor::sensor_wrench(const ControllerState & state)
{
  const ExternalSensor & external = state.external_sensor;
  if (!external.enabled) {
    return state.ft_raw_wrench;
  }
  // The external sensor measures the payload without its own mass.
  const Payload sensor_mass{external.mass, external.center_of_gravity, Vector6::Zero()};
  return shift_wrench(state.external_force_torque, external.measuring_offset) +
         load_wrench(sensor_mass, state.tool_acceleration);
}

void ForceTorqueSensor::step(const Payload & load, ControllerState & state)
{
  const Transform tcp = to_transform(state.actual_tcp_pose);
  const Transform flange = tcp * to_transform(state.tcp_offset).inverse();
  const Eigen::Matrix3d & to_base = flange.linear();
  const Vector3 flange_to_tcp = tcp.translation() - flange.translation();

  const Vector6 contact =
      rotate_spatial_vector(to_base.transpose(), shift_wrench(state.contact_wrench, flange_to_tcp));
  state.ft_raw_wrench = contact + load_wrench(load, state.tool_acceleration) + noise();

  const Vector3 upward = to_base.transpose() * state.gravity;
  const Vector6 unmodeled_load = load_wrench(load, upward) - load_wrench(state.payload, upward);
  state.tool_wrench =
      state.contact_wrench + shift_wrench(rotate_spatial_vector(to_base, unmodeled_load), -flange_to_tcp);

  const Vector6 compensated = sensor_wrench(state) - load_wrench(state.payload, state.tool_acceleration);
  filtered_ = first_cycle_ ? compensated : Vector6(filtered_ + filter_gain_ * (compensated - filtered_));
  first_cycle_ = false;
  if (zero_requested_) {
    offset_ = filtered_;
    zero_requested_ = false;
  }
  force_ = to_base * filtered_.head<3>();
  const Vector6 at_flange = rotate_spatial_vector(to_base, filtered_ - offset_);
  state.actual_tcp_force = shift_wrench(at_flange, -flange_to_tcp);
  state.reported_tcp_force = reports_force_at_flange(model_, state) ? at_flange : state.actual_tcp_force;
}

}  // namespace ur_simulator
