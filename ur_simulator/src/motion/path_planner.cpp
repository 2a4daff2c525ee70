#include "motion/path_planner.hpp"

#include <algorithm>
#include <cmath>

#include "common/pose.hpp"
#include "kinematics/inverse.hpp"

namespace ur_simulator {
namespace {

// Nothing of this room is faster: what clients of the robot may ask for (ur_rtde, UR_TOOL_VELOCITY_MAX,
// UR_TOOL_ACCELERATION_MAX).
constexpr double tool_speed_limit = 3.0;
constexpr double tool_acceleration_limit = 150.0;
// In the corners of movep and movec, which keep their speed there, whatever their own acceleration is.
constexpr double process_acceleration = 10.0;  // m/s^2
// A servoc that would have to turn round more than this stops and goes straight.
constexpr double widest_servo_arc = 4.0;    // rad
constexpr double least_servo_speed = 1e-3;  // m/s

/// The leading joint's speed at which the first joint reaches its own limit.
double speed_limit(const RobotModel & model, const Vector6 & direction)
{
  return model.velocity_max.cwiseQuotient(direction.cwiseAbs().cwiseMax(1e-9)).minCoeff();
}

/// The timing as the options say, before limits.
PathTiming timing_of(double length, const MoveOptions & options)
{
  PathTiming timing;
  timing.length = length;
  timing.speed = options.velocity;
  timing.acceleration = timing.end_acceleration = options.acceleration;
  return timing;
}

SpeedProfile profile_of(const PathTiming & timing, double time, double fastest, double hardest)
{
  return time > 0.0 ? SpeedProfile::in_time(timing, time, fastest, hardest) : SpeedProfile(timing);
}

}  // namespace

PathPlanner::PathPlanner(const RobotModel & model, const CartesianPath & path, const Setpoint & now,
                         double cycle_time, const PathMove * before)
    : model_(model), path_(path), now_(now), cycle_time_(cycle_time), before_(before)
{
  if (before_ == nullptr) {
    return;
  }
  const Transform meeting = before_->target();
  if (const auto * joints = std::get_if<JointLeg>(&before_->leg().way)) {
    before_joints_ = joints->target();
  } else if (const auto posture = path_.joints(meeting, now_.position)) {
    before_joints_ = *posture;
  } else {
    before_ = nullptr;  // its target cannot be reached after all
    return;
  }
  reached_radius_ = (path_.tcp(now_.position).translation() - meeting.translation()).norm();
}

Transform PathPlanner::start() const
{
  return before_ != nullptr ? before_->target() : path_.tcp(now_.position);
}

bool PathPlanner::overlaps(const Transform & target, double blend_radius) const
{
  const double way = (target.translation() - start().translation()).norm();
  const double taken = before_ != nullptr ? before_->leg().blend_radius : 0.0;
  return blend_radius > 0.0 && way < taken + blend_radius;
}

Transform PathPlanner::tcp_at(const PathLeg & leg, double distance) const
{
  if (const auto * joints = std::get_if<JointLeg>(&leg.way)) {
    return path_.tcp(joints->at(distance));
  }
  return std::get<TcpLeg>(leg.way).at(distance);
}

double PathPlanner::within(const PathLeg & leg, double length, double radius, bool at_end) const
{
  const auto away = [&](double distance) {
    return at_end ? tcp_at(leg, length - distance) : tcp_at(leg, distance);
  };
  const Vector3 centre = away(0.0).translation();
  const auto outside = [&](double distance) {
    return (away(distance).translation() - centre).norm() > radius;
  };
  constexpr int steps = 32;
  int first = 1;
  while (first <= steps && !outside(length * first / steps)) {
    ++first;
  }
  if (first > steps) {
    return length;
  }
  double in = length * (first - 1) / steps, out = length * first / steps;
  for (int i = 0; i < 32; ++i) {
    const double middle = 0.5 * (in + out);
    (outside(middle) ? out : in) = middle;
  }
  return in;
}

PathPlanner::Beginning PathPlanner::begin_joints(double acceleration) const
{
  if (before_ != nullptr) {
    return {before_joints_, before_->target(), {}};
  }
  const double brisk = std::max(acceleration, takeover_deceleration);
  const Runout runout(now_.velocity, runout_deceleration(model_, now_, brisk));
  const Vector6 joints = now_.position + runout.total();
  return {joints, path_.tcp(joints), runout};
}

PathPlanner::Beginning PathPlanner::begin_tcp(const Vector6 & twist, double acceleration) const
{
  if (before_ != nullptr) {
    return {before_joints_, before_->target(), {}};
  }
  const Runout runout(twist, Vector6::Constant(std::max(acceleration, takeover_deceleration)));
  Transform tcp = path_.tcp(now_.position);
  tcp.translation() += runout.total().head<3>();
  tcp.linear() = to_rotation(runout.total().tail<3>()) * tcp.linear();
  return {now_.position, tcp, runout};
}

double PathPlanner::joint_acceleration_limit(double blend_radius) const
{
  // In a blend one motion decelerates while the other accelerates.
  const bool blends = before_ != nullptr || blend_radius > 0.0;
  return model_.acceleration_max.minCoeff() * (blends ? 0.5 : 1.0);
}

void PathPlanner::blend(const PathLeg & leg, PathTiming & timing) const
{
  if (leg.blend_radius > 0.0) {
    timing.end_room = within(leg, timing.length, leg.blend_radius, true);
  }
  if (before_ != nullptr) {
    timing.ramp_time = std::max(0.0, before_->leg().profile.duration() - before_->time());
    timing.ramp_room = within(leg, timing.length, reached_radius_, false);
  }
}

PathMove PathPlanner::lay(PathLeg leg, const SpeedProfile & profile, const Runout & runout) const
{
  leg.profile = profile;
  return before_ != nullptr ? PathMove(*before_, leg) : PathMove(model_, path_, leg, runout);
}

PathMove PathPlanner::lay_joint(const Beginning & from, const JointLeg & leg,
                                const MoveOptions & options) const
{
  const PathLeg laid{leg, {}, options.blend_radius, false};
  const double fastest = speed_limit(model_, leg.direction());
  const double hardest = joint_acceleration_limit(options.blend_radius);
  PathTiming timing = timing_of(leg.length(), options);
  timing.speed = std::min(timing.speed, fastest);
  timing.acceleration = timing.end_acceleration = std::min(timing.acceleration, hardest);
  blend(laid, timing);
  return lay(laid, profile_of(timing, options.time, fastest, hardest), from.runout);
}

PathMove PathPlanner::lay_tcp(const Beginning & from, const TcpLeg & leg, const MoveOptions & options,
                              bool process) const
{
  const PathLeg laid{leg, {}, options.blend_radius, process};
  PathTiming timing = timing_of(leg.length(), options);
  timing.speed = std::min(timing.speed, tool_speed_limit);
  timing.acceleration = std::min(timing.acceleration, tool_acceleration_limit);
  timing.end_acceleration =
      process ? std::max(timing.acceleration, process_acceleration) : timing.acceleration;
  timing.release_lead = process ? cycle_time_ : 0.0;
  blend(laid, timing);
  return lay(laid, profile_of(timing, options.time, tool_speed_limit, tool_acceleration_limit), from.runout);
}

PathMove PathPlanner::joint(const Vector6 & target, const MoveOptions & options) const
{
  const Beginning from = begin_joints(options.acceleration);
  return lay_joint(from, JointLeg(from.joints, target), options);
}

PathMove PathPlanner::line(const Transform & target, const MoveOptions & options) const
{
  const Beginning from = begin_tcp(path_.twist(now_), options.acceleration);
  return lay_tcp(from, TcpLeg::line(from.tcp, target), options, false);
}

PathMove PathPlanner::process(const Transform & target, const MoveOptions & options) const
{
  const Beginning from = begin_tcp(path_.twist(now_), options.acceleration);
  const TcpLeg leg = TcpLeg::line(from.tcp, target);
  if (auto cornered = corner(leg, options)) {
    return *cornered;
  }
  return lay_tcp(from, leg, options, true);
}

std::optional<PathMove> PathPlanner::corner(const TcpLeg & out, const MoveOptions & options) const
{
  if (before_ == nullptr || !before_->leg().process) {
    return std::nullopt;
  }
  const auto * in = std::get_if<TcpLeg>(&before_->leg().way);
  const auto reached = before_->leg().profile.at(before_->time());
  const double speed = std::max(reached.speed, std::min(options.velocity, tool_speed_limit));
  const auto leg = TcpLeg::corner(*in, reached.distance, out, speed * speed / process_acceleration);
  if (!leg) {
    return std::nullopt;
  }
  PathTiming timing = timing_of(leg->length(), options);
  timing.start_speed = reached.speed;
  timing.speed = std::min(timing.speed, tool_speed_limit);
  timing.acceleration = std::min(timing.acceleration, tool_acceleration_limit);
  timing.end_acceleration = std::max(timing.acceleration, process_acceleration);
  timing.release_lead = cycle_time_;
  PathLeg laid{*leg, {}, options.blend_radius, true};
  if (options.blend_radius > 0.0) {
    timing.end_room = within(laid, timing.length, options.blend_radius, true);
  }
  laid.profile = SpeedProfile(timing);
  return PathMove(model_, path_, laid);
}

std::optional<PathMove> PathPlanner::circle(const Vector3 & via, const Transform & target, CircleMode mode,
                                            const MoveOptions & options) const
{
  const Beginning from = begin_tcp(path_.twist(now_), options.acceleration);
  const auto leg = TcpLeg::circle(from.tcp, via, target, mode);
  return leg ? std::optional(lay_tcp(from, *leg, options, true)) : std::nullopt;
}

PathMove PathPlanner::servo_circle(const Transform & target, const MoveOptions & options) const
{
  const PathPlanner alone(model_, path_, now_, cycle_time_, nullptr);
  MoveOptions held = options;
  const Vector3 here = path_.tcp(now_.position).translation();
  if ((here - target.translation()).norm() < options.blend_radius) {
    held.blend_radius = 0.0;  // already as near as it would let go
  }
  const auto arc = alone.tangential(target, held);
  return arc ? *arc : alone.line(target, held);
}

std::optional<PathMove> PathPlanner::tangential(const Transform & target, const MoveOptions & options) const
{
  Vector6 twist = path_.twist(now_);
  const Vector3 velocity = twist.head<3>();
  const double speed = velocity.norm();
  if (speed < least_servo_speed) {
    return std::nullopt;
  }
  twist.head<3>().setZero();
  const Beginning from = begin_tcp(twist, options.acceleration);
  const auto leg = TcpLeg::tangent_circle(from.tcp, velocity / speed, target, widest_servo_arc);
  if (!leg || speed * speed > process_acceleration * leg->radius()) {
    return std::nullopt;
  }
  PathLeg laid{*leg, {}, options.blend_radius, false};
  PathTiming timing = timing_of(leg->length(), options);
  timing.speed = std::min(timing.speed, tool_speed_limit);
  timing.acceleration = timing.end_acceleration = std::min(timing.acceleration, tool_acceleration_limit);
  timing.start_speed = speed * leg->length() / leg->tool_way();
  blend(laid, timing);
  laid.profile = SpeedProfile(timing);
  return PathMove(model_, path_, laid, from.runout);
}

PathMove PathPlanner::optimal_joint(const Vector6 & target, MoveOptions options) const
{
  const Beginning from = begin_joints(0.0);
  const JointLeg leg(from.joints, target);
  options.velocity *= speed_limit(model_, leg.direction());
  options.acceleration *= joint_acceleration_limit(options.blend_radius);
  return lay_joint(from, leg, options);
}

PathMove PathPlanner::optimal_line(const Transform & target, MoveOptions options) const
{
  const Beginning from = begin_tcp(path_.twist(now_), 0.0);
  const TcpLeg leg = TcpLeg::line(from.tcp, target);
  const Pace highest = highest_pace(leg, joint_acceleration_limit(options.blend_radius));
  options.velocity *= highest.speed;
  options.acceleration *= highest.acceleration;
  return lay_tcp(from, leg, options, false);
}

PathPlanner::Pace PathPlanner::highest_pace(const TcpLeg & leg, double joint_acceleration) const
{
  // From the slope and the bend of the joints' way over the TCP's: qd = q' v, qdd = q' a + q'' v^2, half of
  // the joints' acceleration for either. The samples may miss the very peak, hence the margin.
  constexpr int steps = 48;
  constexpr double margin = 0.95;
  const double step = leg.length() / steps;
  Pace pace{tool_speed_limit, tool_acceleration_limit};
  Vector6 joints = now_.position, slope = Vector6::Zero();
  for (int i = 0; i <= steps && step > 0.0; ++i) {
    const auto next = path_.joints(leg.at(step * i), joints);
    if (!next) {
      break;  // no posture there: the motion will end in a fault before it
    }
    const Vector6 slope_here = (*next - joints) / step;
    if (i > 0) {
      const double share = slope_here.cwiseAbs().cwiseQuotient(model_.velocity_max).maxCoeff();
      pace.speed = std::min(pace.speed, margin / std::max(share, 1e-9));
      const double steepest = std::max(slope_here.cwiseAbs().maxCoeff(), 1e-9);
      pace.acceleration = std::min(pace.acceleration, 0.5 * margin * joint_acceleration / steepest);
    }
    if (i > 1) {
      const double bend = (slope_here - slope).cwiseAbs().maxCoeff() / step;
      pace.speed = std::min(pace.speed, std::sqrt(0.5 * margin * joint_acceleration / std::max(bend, 1e-9)));
    }
    slope = slope_here;
    joints = *next;
  }
  return pace;
}

}  // namespace ur_simulator
