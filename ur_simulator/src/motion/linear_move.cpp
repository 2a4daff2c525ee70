#include "motion/linear_move.hpp"

#include <algorithm>

#include "common/pose.hpp"

namespace ur_simulator {
namespace {

// Nothing of this room is faster: what clients of the robot may ask for (ur_rtde, UR_TOOL_VELOCITY_MAX,
// UR_TOOL_ACCELERATION_MAX).
constexpr double tool_speed_limit = 3.0;
constexpr double tool_acceleration_limit = 150.0;

}  // namespace

LinearMove::LinearMove(const CartesianPath & path, const Setpoint & from, const Vector6 & target,
                       const MoveOptions & options)
    : path_(path), start_(path.tcp(from.position))
{
  const double brisk = std::max(options.acceleration, takeover_deceleration);
  runout_ = Runout(path.twist(from), Vector6::Constant(brisk));
  const Vector6 left = runout_.total();
  const Transform goal = to_transform(target);
  const Eigen::Matrix3d left_rotation = to_rotation(left.tail<3>()) * start_.linear();
  way_ = goal.translation() - start_.translation() - left.head<3>();
  turn_ = to_rotation_vector(left_rotation.transpose() * goal.linear());
  length_ = std::max(way_.norm(), turning_radius * turn_.norm());
  if (length_ < 1e-12) {
    length_ = 1.0;
    return;
  }
  const double acceleration = std::min(options.acceleration, tool_acceleration_limit);
  if (options.time > 0.0) {
    profile_ = TrapezoidProfile::in_time(length_, options.time, acceleration, tool_speed_limit,
                                         tool_acceleration_limit);
  } else {
    profile_ = TrapezoidProfile(length_, std::min(options.velocity, tool_speed_limit), acceleration);
  }
}

Transform LinearMove::pose_at(double distance) const
{
  const Vector6 run = runout_.displacement();
  const double fraction = distance / length_;
  Transform pose = Transform::Identity();
  pose.translation() = start_.translation() + run.head<3>() + fraction * way_;
  pose.linear() = to_rotation(run.tail<3>()) * start_.linear() * to_rotation(fraction * turn_);
  return pose;
}

std::optional<MotionFault> LinearMove::advance(const Tick & tick, Setpoint & now)
{
  runout_.advance(tick.duration);
  clock_.advance(tick.duration, tick.speed_scaling);
  const auto along = profile_.at(clock_.time());
  if (const auto fault = path_.follow(pose_at(along.distance), tick.duration, now)) {
    return fault;
  }
  if (runout_.over() && (clock_.time() >= profile_.duration() || clock_.stopped())) {
    now.velocity.setZero();
    done_ = true;
  }
  return std::nullopt;
}

void LinearMove::brake()
{
  clock_.brake(profile_.at(clock_.time()).speed, std::max(profile_.acceleration(), takeover_deceleration));
}

}  // namespace ur_simulator
