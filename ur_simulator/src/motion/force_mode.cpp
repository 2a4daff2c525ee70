#include "motion/force_mode.hpp"

#include <algorithm>
#include <cmath>

#include "common/pose.hpp"
#include "kinematics/inverse.hpp"

namespace ur_simulator {
namespace {

// Of the admittance that the arm shows at scaling 1. Chosen so that contact settles without ringing on
// surfaces of 2 to 200 N/mm (docs/simulator_physics.md); the robot's own figures are not published.
constexpr double mass = 25.0;            // kg
constexpr double inertia = 1.0;          // kg m^2
constexpr double rate_time = 0.1;        // s
constexpr double full_damping = 50.0;    // 1/s at damping 1
constexpr double acceleration = 10.0;    // m/s^2
constexpr double turning = 50.0;         // rad/s^2
constexpr double yield_time = 0.05;      // s in which other axes give way
constexpr double least_motion = 1e-3;    // m/s: a slower TCP has no direction
constexpr double least_distance = 0.01;  // m to the origin of a `to_point` frame, as the manual asks for

Vector6 to_axes(const Eigen::Matrix3d & axes, const Vector6 & in_base)
{
  return rotate_pair(axes.transpose(), in_base);
}

/// Orthonormal with the given y (x) axis, the others near those of `original`.
Eigen::Matrix3d with_y(const Vector3 & y, const Eigen::Matrix3d & original)
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
  axes_ = to_rotation(settings.frame.tail<3>());
  has_axes_ = settings.type != ForceModeSettings::Type::along_motion;
}

void ForceMode::update(const ForceModeSettings & settings)
{
  const bool another_type = settings.type != settings_.type;
  const bool another_frame = settings.frame != settings_.frame;
  settings_ = settings;
  if (another_type || another_frame) {
    axes_ = to_rotation(settings.frame.tail<3>());
    has_axes_ = settings.type != ForceModeSettings::Type::along_motion;
  }
}

void ForceMode::turn_frame(const Transform & tcp, const Vector6 & program_twist)
{
  const Eigen::Matrix3d original = to_rotation(settings_.frame.tail<3>());
  switch (settings_.type) {
    case ForceModeSettings::Type::fixed:
      return;
    case ForceModeSettings::Type::tool:
      axes_ = tcp.linear();
      return;
    case ForceModeSettings::Type::to_point: {
      const Vector3 way = settings_.frame.head<3>() - tcp.translation();
      if (way.norm() >= least_distance) {
        axes_ = with_y(way.normalized(), original);
      }
      return;
    }
    case ForceModeSettings::Type::along_motion: {
      // The program's velocity: that of the compliance would turn the frame it acts in.
      const Vector3 normal = original.col(2);
      const Vector3 along = program_twist.head<3>() - normal * normal.dot(program_twist.head<3>());
      if (along.norm() >= least_motion) {
        axes_ = with_y(normal.cross(along.normalized()), original);
        has_axes_ = true;
      }
      return;
    }
  }
}

bool ForceMode::compliant(Eigen::Index axis) const
{
  return has_axes_ && settings_.compliant[static_cast<std::size_t>(axis)];
}

double ForceMode::next_speed(Eigen::Index axis, double error, double error_rate, double damping,
                             double scaling, double speed) const
{
  const bool linear = axis < 3;
  const double fastest = linear ? acceleration : turning;
  const double pull = scaling * (error + rate_time * error_rate) / (linear ? mass : inertia);
  const double change = std::clamp(pull - full_damping * damping * speed, -fastest, fastest);
  const double limit = settings_.limits[axis];
  return std::clamp(speed + change * cycle_time_, -limit, limit);
}

std::optional<MotionFault> ForceMode::advance(const Setpoint & program, const ControllerState & state,
                                              double scaling, double damping, bool hold, Setpoint & commanded)
{
  const CartesianPath path(*model_, state.tcp_offset);
  const Transform tcp = path.tcp(program.position);
  turn_frame(tcp, path.twist(program));
  Vector6 moved;
  moved << tcp.translation() - program_before_.translation(),
      to_rotation_vector(tcp.linear() * program_before_.linear().transpose());
  const Vector6 program_way = first_ ? Vector6(Vector6::Zero()) : to_axes(axes_, moved);
  const Vector6 force = to_axes(axes_, state.actual_tcp_force);
  const Vector6 rate = first_ ? Vector6(Vector6::Zero())
                              : to_axes(axes_, (state.actual_tcp_force - force_before_) / cycle_time_);
  first_ = false;
  program_before_ = tcp;
  force_before_ = state.actual_tcp_force;

  Vector6 speed = to_axes(axes_, speed_);
  Vector6 deviation = to_axes(axes_, deviation_);
  for (Eigen::Index i = 0; i < 6; ++i) {
    if (!compliant(i)) {
      const double yielding = force[i] / (i < 3 ? hold_stiffness : hold_turning_stiffness);
      deviation[i] += (yielding - deviation[i]) * (1.0 - std::exp(-cycle_time_ / yield_time));
      speed[i] = 0.0;
      continue;
    }
    const double step = (i < 3 ? acceleration : turning) * cycle_time_;
    speed[i] = hold ? speed[i] - std::clamp(speed[i], -step, step)
                    : next_speed(i, settings_.wrench[i] + force[i], rate[i], damping, scaling, speed[i]);
    deviation[i] += speed[i] * cycle_time_ - program_way[i];
  }
  speed_ = rotate_pair(axes_, speed);
  deviation_ = rotate_pair(axes_, deviation);
  if (const auto fault = beyond_limit(deviation)) {
    return fault;
  }
  return path.follow(displaced(tcp), cycle_time_, commanded);
}

std::optional<MotionFault> ForceMode::beyond_limit(const Vector6 & deviation) const
{
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double limit = settings_.limits[i];
    if (!compliant(i) && std::abs(deviation[i]) > limit) {
      return MotionFault{MotionFault::Kind::force_mode_deviation, static_cast<int>(i), deviation[i], limit};
    }
  }
  return std::nullopt;
}

Transform ForceMode::displaced(const Transform & tcp) const
{
  Transform pose = Transform::Identity();
  pose.translation() = tcp.translation() + deviation_.head<3>();
  pose.linear() = to_rotation(deviation_.tail<3>()) * tcp.linear();
  return pose;
}

void ForceMode::fold(const ControllerState & state, Setpoint & program)
{
  Vector6 folded = to_axes(axes_, deviation_);
  Vector6 kept = folded;
  for (Eigen::Index i = 0; i < 6; ++i) {
    (compliant(i) ? kept : folded)[i] = 0.0;
  }
  const Vector6 shift = rotate_pair(axes_, folded);
  const CartesianPath path(*model_, state.tcp_offset);
  Transform tcp = path.tcp(program.position);
  tcp.translation() += shift.head<3>();
  tcp.linear() = to_rotation(shift.tail<3>()) * tcp.linear();
  const Transform flange = tcp * to_transform(state.tcp_offset).inverse();
  if (const auto joints = inverse_nearest(*model_, flange, program.position)) {
    program = {*joints, Vector6::Zero()};
    program_before_ = tcp;
    deviation_ = rotate_pair(axes_, kept);
  }
}

}  // namespace ur_simulator
