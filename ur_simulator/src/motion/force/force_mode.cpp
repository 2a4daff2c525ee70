#include "motion/force/force_mode.hpp"

#include <algorithm>
#include <cmath>

#include "common/pose.hpp"
#include "kinematics/inverse_kinematics.hpp"

namespace ur_simulator {
namespace {

// Admittance of the arm at scaling 1. Chosen so that contact settles without oscillation on surfaces of 2 to
// 200 N/mm; UR does not publish the values of the robot.
constexpr double virtual_mass = 25.0;              // kg
constexpr double virtual_inertia = 1.0;            // kg m^2
constexpr double derivative_time = 0.1;            // s
constexpr double max_damping_rate = 50.0;          // 1/s at damping 1
constexpr double max_linear_acceleration = 10.0;   // m/s^2
constexpr double max_angular_acceleration = 50.0;  // rad/s^2
constexpr double compliance_time = 0.05;           // s, time constant of the axes that are not compliant
constexpr double min_tcp_speed = 1e-3;             // m/s: below, the TCP has no direction of motion
constexpr double min_point_distance =
    0.01;  // m from the TCP to the origin of a `to_point` frame (script manual, "force_mode")

Vector6 to_task_frame(const Eigen::Matrix3d & axes, const Vector6 & in_base)
{
  return rotate_spatial_vector(axes.transpose(), in_base);
}

/// The orthonormal frame with this y axis whose z axis is nearest to that of `original`.
Eigen::Matrix3d frame_with_y_axis(const Vector3 & y, const Eigen::Matrix3d & original)
{
  Vector3 x = y.cross(original.col(2));
  if (x.norm() < 1e-3) {
    x = original.col(0) - y * y.dot(original.col(0));
  }
  Eigen::Matrix3d axes;
  axes.col(0) = x.normalized();
  axes.col(1) = y;
  axes.col(2) = axes.col(0).cross(y);
  return axes;
}

}  // namespace

ForceMode::ForceMode(const RobotModel & model, double cycle_time, const ForceModeSettings & settings)
    : model_(&model), cycle_time_(cycle_time), settings_(settings)
{
  axes_ = to_rotation_matrix(settings.frame.tail<3>());
  axes_defined_ = settings.type != ForceModeSettings::Type::along_motion;
}

void ForceMode::update(const ForceModeSettings & settings)
{
  const bool type_changed = settings.type != settings_.type;
  const bool frame_changed = settings.frame != settings_.frame;
  settings_ = settings;
  if (type_changed || frame_changed) {
    axes_ = to_rotation_matrix(settings.frame.tail<3>());
    axes_defined_ = settings.type != ForceModeSettings::Type::along_motion;
  }
}

void ForceMode::update_frame(const Transform & tcp, const Vector6 & program_twist)
{
  const Eigen::Matrix3d original = to_rotation_matrix(settings_.frame.tail<3>());
  switch (settings_.type) {
    case ForceModeSettings::Type::fixed:
      return;
    case ForceModeSettings::Type::tool:
      axes_ = tcp.linear();
      return;
    case ForceModeSettings::Type::to_point: {
      const Vector3 to_origin = settings_.frame.head<3>() - tcp.translation();
      if (to_origin.norm() >= min_point_distance) {
        axes_ = frame_with_y_axis(to_origin.normalized(), original);
      }
      return;
    }
    case ForceModeSettings::Type::along_motion: {
      // The velocity of the program: the velocity of the compliance would rotate its own frame.
      const Vector3 normal = original.col(2);
      const Vector3 direction = program_twist.head<3>() - normal * normal.dot(program_twist.head<3>());
      if (direction.norm() >= min_tcp_speed) {
        axes_ = frame_with_y_axis(normal.cross(direction.normalized()), original);
        axes_defined_ = true;
      }
      return;
    }
  }
}

bool ForceMode::compliant(Eigen::Index axis) const
{
  return axes_defined_ && settings_.compliant[static_cast<std::size_t>(axis)];
}

double ForceMode::next_speed(Eigen::Index axis, double error, double error_rate, double damping,
                             double scaling, double speed) const
{
  const bool linear = axis < 3;
  const double max_acceleration = linear ? max_linear_acceleration : max_angular_acceleration;
  const double target_acceleration =
      scaling * (error + derivative_time * error_rate) / (linear ? virtual_mass : virtual_inertia);
  const double acceleration = std::clamp(target_acceleration - max_damping_rate * damping * speed,
                                         -max_acceleration, max_acceleration);
  const double limit = settings_.limits[axis];
  return std::clamp(speed + acceleration * cycle_time_, -limit, limit);
}

ForceMode::Measurement ForceMode::measure(const Transform & program_tcp, const Vector6 & force)
{
  Measurement measurement;
  measurement.force = to_task_frame(axes_, force);
  if (!first_cycle_) {
    Vector6 motion;
    motion << program_tcp.translation() - previous_program_tcp_.translation(),
        to_rotation_vector(program_tcp.linear() * previous_program_tcp_.linear().transpose());
    measurement.program_motion = to_task_frame(axes_, motion);
    measurement.force_rate = to_task_frame(axes_, (force - previous_force_) / cycle_time_);
  }
  first_cycle_ = false;
  previous_program_tcp_ = program_tcp;
  previous_force_ = force;
  return measurement;
}

std::optional<MotionFault> ForceMode::advance(const Setpoint & program, const ControllerState & state,
                                              double scaling, double damping, bool hold_position,
                                              Setpoint & commanded)
{
  const TcpKinematics kinematics(*model_, state.tcp_offset);
  const Transform tcp = kinematics.tcp_pose(program.position);
  update_frame(tcp, kinematics.tcp_twist(program));
  const Measurement measurement = measure(tcp, state.actual_tcp_force);
  Vector6 speed = to_task_frame(axes_, speed_);
  Vector6 deviation = to_task_frame(axes_, deviation_);
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double force = measurement.force[i];
    if (!compliant(i)) {
      const double elastic_deviation = force / (i < 3 ? linear_stiffness : angular_stiffness);
      deviation[i] += (elastic_deviation - deviation[i]) * (1.0 - std::exp(-cycle_time_ / compliance_time));
      speed[i] = 0.0;
      continue;
    }
    const double step = (i < 3 ? max_linear_acceleration : max_angular_acceleration) * cycle_time_;
    speed[i] = hold_position ? speed[i] - std::clamp(speed[i], -step, step)
                             : next_speed(i, settings_.wrench[i] + force, measurement.force_rate[i], damping,
                                          scaling, speed[i]);
    deviation[i] += speed[i] * cycle_time_ - measurement.program_motion[i];
  }
  speed_ = rotate_spatial_vector(axes_, speed);
  deviation_ = rotate_spatial_vector(axes_, deviation);
  if (const auto fault = check_deviation(deviation)) {
    return fault;
  }
  return kinematics.move_to(add_deviation(tcp), cycle_time_, commanded);
}

std::optional<MotionFault> ForceMode::check_deviation(const Vector6 & deviation) const
{
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double limit = settings_.limits[i];
    if (!compliant(i) && std::abs(deviation[i]) > limit) {
      return MotionFault{MotionFault::Kind::force_mode_deviation, static_cast<int>(i), deviation[i], limit};
    }
  }
  return std::nullopt;
}

Transform ForceMode::add_deviation(const Transform & tcp) const
{
  Transform pose = Transform::Identity();
  pose.translation() = tcp.translation() + deviation_.head<3>();
  pose.linear() = to_rotation_matrix(deviation_.tail<3>()) * tcp.linear();
  return pose;
}

void ForceMode::absorb_deviation(const ControllerState & state, Setpoint & program)
{
  Vector6 absorbed = to_task_frame(axes_, deviation_);
  Vector6 kept = absorbed;
  for (Eigen::Index i = 0; i < 6; ++i) {
    (compliant(i) ? kept : absorbed)[i] = 0.0;
  }
  const Vector6 shift = rotate_spatial_vector(axes_, absorbed);
  const TcpKinematics kinematics(*model_, state.tcp_offset);
  Transform tcp = kinematics.tcp_pose(program.position);
  tcp.translation() += shift.head<3>();
  tcp.linear() = to_rotation_matrix(shift.tail<3>()) * tcp.linear();
  const Transform flange = tcp * to_transform(state.tcp_offset).inverse();
  if (const auto joints = nearest_inverse_solution(*model_, flange, program.position)) {
    program = {*joints, Vector6::Zero()};
    previous_program_tcp_ = tcp;
    deviation_ = rotate_spatial_vector(axes_, kept);
  }
}

}  // namespace ur_simulator
