#include "motion/path/path_planner.hpp"

#include <algorithm>
#include <cmath>

#include "common/pose.hpp"
#include "kinematics/inverse_kinematics.hpp"

namespace ur_simulator {
namespace {

// Highest values that ur_rtde accepts: UR_TOOL_VELOCITY_MAX, UR_TOOL_ACCELERATION_MAX.
constexpr double tool_speed_limit = 3.0;           // m/s
constexpr double tool_acceleration_limit = 150.0;  // m/s^2
// Highest acceleration in the corners of movep and movec, which keep their speed there; independent of the
// acceleration of the motion.
constexpr double corner_acceleration = 10.0;  // m/s^2
// A servoc that would need a longer arc stops and moves straight.
constexpr double max_servo_arc = 4.0;     // rad
constexpr double min_servo_speed = 1e-3;  // m/s

/// The speed of the leading joint at which the first joint reaches its own limit.
double leading_joint_speed_limit(const RobotModel & model, const Vector6 & direction)
{
  return model.velocity_max.cwiseQuotient(direction.cwiseAbs().cwiseMax(1e-9)).minCoeff();
}

/// The constraints of the options, before limits are applied.
ProfileConstraints constraints_from(double length, const MoveOptions & options)
{
  ProfileConstraints constraints;
  constraints.length = length;
  constraints.speed = options.velocity;
  constraints.acceleration = constraints.blend_out_acceleration = options.acceleration;
  return constraints;
}

SpeedProfile make_profile(const ProfileConstraints & constraints, double time, double max_speed,
                          double max_acceleration)
{
  return time > 0.0 ? SpeedProfile::with_duration(constraints, time, max_speed, max_acceleration)
                    : SpeedProfile(constraints);
}

}  // namespace

PathPlanner::PathPlanner(const RobotModel & model, const TcpKinematics & kinematics,
                         const Setpoint & setpoint, double cycle_time, const PathMotion * previous)
    : model_(model),
      kinematics_(kinematics),
      setpoint_(setpoint),
      cycle_time_(cycle_time),
      previous_(previous)
{
  if (previous_ == nullptr) {
    return;
  }
  const Transform waypoint = previous_->target();
  if (const auto * joints = std::get_if<JointSegment>(&previous_->segment().geometry)) {
    previous_target_joints_ = joints->target();
  } else if (const auto solution = kinematics_.inverse(waypoint, setpoint_.position)) {
    previous_target_joints_ = *solution;
  } else {
    previous_ = nullptr;  // its target is unreachable
    return;
  }
  distance_to_waypoint_ =
      (kinematics_.tcp_pose(setpoint_.position).translation() - waypoint.translation()).norm();
}

Transform PathPlanner::start() const
{
  return previous_ != nullptr ? previous_->target() : kinematics_.tcp_pose(setpoint_.position);
}

bool PathPlanner::overlaps(const Transform & target, double blend_radius) const
{
  const double distance = (target.translation() - start().translation()).norm();
  const double previous_radius = previous_ != nullptr ? previous_->segment().blend_radius : 0.0;
  return blend_radius > 0.0 && distance < previous_radius + blend_radius;
}

double PathPlanner::length_within_radius(const PathSegment & segment, double length, double radius,
                                         bool at_end) const
{
  const auto pose_at = [&](double distance) {
    return at_end ? tcp_pose_at(kinematics_, segment, length - distance)
                  : tcp_pose_at(kinematics_, segment, distance);
  };
  const Vector3 center = pose_at(0.0).translation();
  const auto outside = [&](double distance) {
    return (pose_at(distance).translation() - center).norm() > radius;
  };
  constexpr int steps = 32;
  int first_outside = 1;
  while (first_outside <= steps && !outside(length * first_outside / steps)) {
    ++first_outside;
  }
  if (first_outside > steps) {
    return length;
  }
  double inside_distance = length * (first_outside - 1) / steps,
         outside_distance = length * first_outside / steps;
  for (int i = 0; i < 32; ++i) {
    const double middle = 0.5 * (inside_distance + outside_distance);
    (outside(middle) ? outside_distance : inside_distance) = middle;
  }
  return inside_distance;
}

PathPlanner::PathStart PathPlanner::joint_path_start(double acceleration) const
{
  if (previous_ != nullptr) {
    return {previous_target_joints_, previous_->target(), {}};
  }
  const double deceleration = std::max(acceleration, min_takeover_deceleration);
  const ResidualMotion residual(setpoint_.velocity, residual_deceleration(model_, setpoint_, deceleration));
  const Vector6 joints = setpoint_.position + residual.total_displacement();
  return {joints, kinematics_.tcp_pose(joints), residual};
}

PathPlanner::PathStart PathPlanner::tcp_path_start(const Vector6 & twist, double acceleration) const
{
  if (previous_ != nullptr) {
    return {previous_target_joints_, previous_->target(), {}};
  }
  const ResidualMotion residual(twist, Vector6::Constant(std::max(acceleration, min_takeover_deceleration)));
  Transform tcp = kinematics_.tcp_pose(setpoint_.position);
  tcp.translation() += residual.total_displacement().head<3>();
  tcp.linear() = to_rotation_matrix(residual.total_displacement().tail<3>()) * tcp.linear();
  return {setpoint_.position, tcp, residual};
}

double PathPlanner::joint_acceleration_limit(double blend_radius) const
{
  // In a blend one motion decelerates while the other accelerates.
  const bool blends = previous_ != nullptr || blend_radius > 0.0;
  return model_.acceleration_max.minCoeff() * (blends ? 0.5 : 1.0);
}

void PathPlanner::set_blend_timing(const PathSegment & segment, ProfileConstraints & constraints) const
{
  if (segment.blend_radius > 0.0) {
    constraints.blend_out_distance =
        length_within_radius(segment, constraints.length, segment.blend_radius, true);
  }
  if (previous_ != nullptr) {
    constraints.blend_in_time = std::max(0.0, previous_->segment().profile.duration() - previous_->time());
    constraints.blend_in_distance =
        length_within_radius(segment, constraints.length, distance_to_waypoint_, false);
  }
}

PathMotion PathPlanner::make_path(PathSegment segment, const SpeedProfile & profile,
                                  const ResidualMotion & residual) const
{
  segment.profile = profile;
  return previous_ != nullptr ? PathMotion(*previous_, segment)
                              : PathMotion(model_, kinematics_, segment, residual);
}

PathMotion PathPlanner::make_joint_path(const PathStart & path_start, const JointSegment & segment,
                                        const MoveOptions & options) const
{
  const PathSegment planned{segment, {}, options.blend_radius, false};
  const double max_speed = leading_joint_speed_limit(model_, segment.direction());
  const double max_acceleration = joint_acceleration_limit(options.blend_radius);
  ProfileConstraints constraints = constraints_from(segment.length(), options);
  constraints.speed = std::min(constraints.speed, max_speed);
  constraints.acceleration = constraints.blend_out_acceleration =
      std::min(constraints.acceleration, max_acceleration);
  set_blend_timing(planned, constraints);
  return make_path(planned, make_profile(constraints, options.time, max_speed, max_acceleration),
                   path_start.residual);
}

PathMotion PathPlanner::make_tcp_path(const PathStart & path_start, const TcpSegment & segment,
                                      const MoveOptions & options, bool process) const
{
  const PathSegment planned{segment, {}, options.blend_radius, process};
  ProfileConstraints constraints = constraints_from(segment.length(), options);
  constraints.speed = std::min(constraints.speed, tool_speed_limit);
  constraints.acceleration = std::min(constraints.acceleration, tool_acceleration_limit);
  constraints.blend_out_acceleration =
      process ? std::max(constraints.acceleration, corner_acceleration) : constraints.acceleration;
  constraints.blend_start_lead = process ? cycle_time_ : 0.0;
  set_blend_timing(planned, constraints);
  return make_path(planned,
                   make_profile(constraints, options.time, tool_speed_limit, tool_acceleration_limit),
                   path_start.residual);
}

PathMotion PathPlanner::plan_joint(const Vector6 & target, const MoveOptions & options) const
{
  const PathStart path_start = joint_path_start(options.acceleration);
  return make_joint_path(path_start, JointSegment(path_start.joints, target), options);
}

PathMotion PathPlanner::plan_line(const Transform & target, const MoveOptions & options) const
{
  const PathStart path_start = tcp_path_start(kinematics_.tcp_twist(setpoint_), options.acceleration);
  return make_tcp_path(path_start, TcpSegment::line(path_start.tcp, target), options, false);
}

PathMotion PathPlanner::plan_process(const Transform & target, const MoveOptions & options) const
{
  const PathStart path_start = tcp_path_start(kinematics_.tcp_twist(setpoint_), options.acceleration);
  const TcpSegment segment = TcpSegment::line(path_start.tcp, target);
  if (auto cornered = plan_corner(segment, options)) {
    return *cornered;
  }
  return make_tcp_path(path_start, segment, options, true);
}

std::optional<PathMotion> PathPlanner::plan_corner(const TcpSegment & outgoing,
                                                   const MoveOptions & options) const
{
  if (previous_ == nullptr || !previous_->segment().process) {
    return std::nullopt;
  }
  const auto * incoming = std::get_if<TcpSegment>(&previous_->segment().geometry);
  const auto reached = previous_->segment().profile.sample(previous_->time());
  const double speed = std::max(reached.speed, std::min(options.velocity, tool_speed_limit));
  const auto segment =
      TcpSegment::corner(*incoming, reached.distance, outgoing, speed * speed / corner_acceleration);
  if (!segment) {
    return std::nullopt;
  }
  ProfileConstraints constraints = constraints_from(segment->length(), options);
  constraints.start_speed = reached.speed;
  constraints.speed = std::min(constraints.speed, tool_speed_limit);
  constraints.acceleration = std::min(constraints.acceleration, tool_acceleration_limit);
  constraints.blend_out_acceleration = std::max(constraints.acceleration, corner_acceleration);
  constraints.blend_start_lead = cycle_time_;
  PathSegment planned{*segment, {}, options.blend_radius, true};
  if (options.blend_radius > 0.0) {
    constraints.blend_out_distance =
        length_within_radius(planned, constraints.length, options.blend_radius, true);
  }
  planned.profile = SpeedProfile(constraints);
  return PathMotion(model_, kinematics_, planned);
}

std::optional<PathMotion> PathPlanner::plan_circle(const Vector3 & via, const Transform & target,
                                                   CircleMode mode, const MoveOptions & options) const
{
  const PathStart path_start = tcp_path_start(kinematics_.tcp_twist(setpoint_), options.acceleration);
  const auto segment = TcpSegment::circle(path_start.tcp, via, target, mode);
  return segment ? std::optional(make_tcp_path(path_start, *segment, options, true)) : std::nullopt;
}

PathMotion PathPlanner::plan_servo_circle(const Transform & target, const MoveOptions & options) const
{
  const PathPlanner without_blend(model_, kinematics_, setpoint_, cycle_time_, nullptr);
  MoveOptions servo_options = options;
  const Vector3 here = kinematics_.tcp_pose(setpoint_.position).translation();
  if ((here - target.translation()).norm() < options.blend_radius) {
    servo_options.blend_radius = 0.0;  // already inside the blend
  }
  const auto arc = without_blend.plan_tangent_arc(target, servo_options);
  return arc ? *arc : without_blend.plan_line(target, servo_options);
}

std::optional<PathMotion> PathPlanner::plan_tangent_arc(const Transform & target,
                                                        const MoveOptions & options) const
{
  Vector6 twist = kinematics_.tcp_twist(setpoint_);
  const Vector3 velocity = twist.head<3>();
  const double speed = velocity.norm();
  if (speed < min_servo_speed) {
    return std::nullopt;
  }
  twist.head<3>().setZero();
  const PathStart path_start = tcp_path_start(twist, options.acceleration);
  const auto segment = TcpSegment::tangent_circle(path_start.tcp, velocity / speed, target, max_servo_arc);
  if (!segment || speed * speed > corner_acceleration * segment->radius()) {
    return std::nullopt;
  }
  PathSegment planned{*segment, {}, options.blend_radius, false};
  ProfileConstraints constraints = constraints_from(segment->length(), options);
  constraints.speed = std::min(constraints.speed, tool_speed_limit);
  constraints.acceleration = constraints.blend_out_acceleration =
      std::min(constraints.acceleration, tool_acceleration_limit);
  constraints.start_speed = speed * segment->length() / segment->tcp_path_length();
  set_blend_timing(planned, constraints);
  planned.profile = SpeedProfile(constraints);
  return PathMotion(model_, kinematics_, planned, path_start.residual);
}

PathMotion PathPlanner::plan_optimal_joint(const Vector6 & target, MoveOptions options) const
{
  const PathStart path_start = joint_path_start(0.0);
  const JointSegment segment(path_start.joints, target);
  options.velocity *= leading_joint_speed_limit(model_, segment.direction());
  options.acceleration *= joint_acceleration_limit(options.blend_radius);
  return make_joint_path(path_start, segment, options);
}

PathMotion PathPlanner::plan_optimal_line(const Transform & target, MoveOptions options) const
{
  const PathStart path_start = tcp_path_start(kinematics_.tcp_twist(setpoint_), 0.0);
  const TcpSegment segment = TcpSegment::line(path_start.tcp, target);
  const PathLimits highest = path_limits(segment, joint_acceleration_limit(options.blend_radius));
  options.velocity *= highest.speed;
  options.acceleration *= highest.acceleration;
  return make_tcp_path(path_start, segment, options, false);
}

PathPlanner::PathLimits PathPlanner::path_limits(const TcpSegment & segment, double joint_acceleration) const
{
  // From the derivatives of the joint position q with respect to the path length: qd = q' v, qdd = q' a + q''
  // v^2. Each term may use half of the joint acceleration. The samples may miss a peak, hence the margin.
  constexpr int steps = 48;
  constexpr double margin = 0.95;
  const double step = segment.length() / steps;
  PathLimits limits{tool_speed_limit, tool_acceleration_limit};
  Vector6 joints = setpoint_.position, slope = Vector6::Zero();
  for (int i = 0; i <= steps && step > 0.0; ++i) {
    const auto next = kinematics_.inverse(segment.at(step * i), joints);
    if (!next) {
      break;  // unreachable: the motion ends in a fault before this point
    }
    const Vector6 slope_here = (*next - joints) / step;
    if (i > 0) {
      const double speed_ratio = slope_here.cwiseAbs().cwiseQuotient(model_.velocity_max).maxCoeff();
      limits.speed = std::min(limits.speed, margin / std::max(speed_ratio, 1e-9));
      const double max_slope = std::max(slope_here.cwiseAbs().maxCoeff(), 1e-9);
      limits.acceleration = std::min(limits.acceleration, 0.5 * margin * joint_acceleration / max_slope);
    }
    if (i > 1) {
      const double curvature = (slope_here - slope).cwiseAbs().maxCoeff() / step;
      limits.speed =
          std::min(limits.speed, std::sqrt(0.5 * margin * joint_acceleration / std::max(curvature, 1e-9)));
    }
    slope = slope_here;
    joints = *next;
  }
  return limits;
}

}  // namespace ur_simulator
