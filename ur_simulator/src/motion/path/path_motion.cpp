#include "motion/path/path_motion.hpp"

#include <algorithm>

#include "common/pose.hpp"

namespace ur_simulator {
namespace {

bool is_joint(const PathSegment & segment)
{
  return std::holds_alternative<JointSegment>(segment.geometry);
}

}  // namespace

Transform tcp_pose_at(const TcpKinematics & kinematics, const PathSegment & segment, double distance)
{
  if (const auto * joints = std::get_if<JointSegment>(&segment.geometry)) {
    return kinematics.tcp_pose(joints->at(distance));
  }
  return std::get<TcpSegment>(segment.geometry).at(distance);
}

PathMotion::PathMotion(const RobotModel & model, const TcpKinematics & kinematics,
                       const PathSegment & segment, const ResidualMotion & residual)
    : model_(&model),
      kinematics_(kinematics),
      segment_(segment),
      start_tcp_(tcp_pose_at(kinematics_, segment, 0.0)),
      residual_(residual)
{
}

PathMotion::PathMotion(const PathMotion & previous, const PathSegment & segment)
    : model_(previous.model_),
      kinematics_(previous.kinematics_),
      segment_(segment),
      start_tcp_(tcp_pose_at(kinematics_, segment, 0.0)),
      blends_(true),
      previous_(previous.segment_),
      previous_start_time_(previous.clock_.time())
{
}

Transform PathMotion::target() const
{
  if (const auto * joints = std::get_if<JointSegment>(&segment_.geometry)) {
    return kinematics_.tcp_pose(joints->target());
  }
  return std::get<TcpSegment>(segment_.geometry).target();
}

bool PathMotion::previous_finished() const
{
  return !blends_ || previous_time() >= previous_.profile.duration();
}

bool PathMotion::call_complete() const
{
  return finished_ || (advanced_ && previous_finished() && residual_.finished() &&
                       clock_.time() >= segment_.profile.blend_start_time());
}

bool PathMotion::in_blend() const
{
  return !finished_ && !clock_.decelerating() && call_complete();
}

std::optional<MotionFault> PathMotion::advance(const TimeStep & time_step, Setpoint & setpoint)
{
  if (!advanced_) {
    find_rate_limit(setpoint.position);
  }
  advanced_ = true;
  residual_.advance(time_step.duration);
  clock_.advance(time_step.duration, time_step.speed_scaling * rate_limit_.at(clock_.time()));
  const bool joints_only = is_joint(segment_) && (previous_finished() || is_joint(previous_));
  const auto fault = joints_only ? advance_joints(time_step, setpoint) : advance_tcp(time_step, setpoint);
  if (fault) {
    return fault;
  }
  const bool at_target = previous_finished() && clock_.time() >= segment_.profile.duration();
  if (residual_.finished() && (at_target || clock_.stopped())) {
    if (const auto * joints = std::get_if<JointSegment>(&segment_.geometry); joints != nullptr && at_target) {
      setpoint.position = joints->target();
    }
    setpoint.velocity.setZero();
    finished_ = true;
  }
  return std::nullopt;
}

void PathMotion::find_rate_limit(const Vector6 & near_start)
{
  if (const auto * path = std::get_if<TcpSegment>(&segment_.geometry)) {
    rate_limit_ = RateLimit(*model_, kinematics_, *path, segment_.profile, near_start);
  }
}

std::optional<MotionFault> PathMotion::advance_joints(const TimeStep & time_step, Setpoint & setpoint)
{
  const auto & line = std::get<JointSegment>(segment_.geometry);
  const auto sample = segment_.profile.sample(clock_.time());
  const double rate = clock_.rate() * time_step.speed_scaling;
  Setpoint next{line.at(sample.distance) + residual_.displacement() - residual_.total_displacement(),
                residual_.velocity() + rate * sample.speed * line.direction()};
  if (!previous_finished()) {
    const auto & previous_line = std::get<JointSegment>(previous_.geometry);
    const auto previous_sample = previous_.profile.sample(previous_time());
    next.position += previous_line.at(previous_sample.distance) - previous_line.target();
    next.velocity += rate * previous_sample.speed * previous_line.direction();
  }
  if (const auto fault = check_jump(setpoint, next.position, time_step.duration)) {
    return fault;
  }
  setpoint = next;
  return std::nullopt;
}

std::optional<MotionFault> PathMotion::check_jump(const Setpoint & setpoint, const Vector6 & next,
                                                  double duration) const
{
  // A blend with a Cartesian motion may end in another joint configuration than the joint motion expects.
  constexpr double max_speed_ratio = 3.0;  // more than any motion
  Eigen::Index worst = 0;
  const Vector6 speed = (next - setpoint.position).cwiseAbs() / duration;
  if (speed.cwiseQuotient(model_->velocity_max).maxCoeff(&worst) < max_speed_ratio) {
    return std::nullopt;
  }
  return MotionFault{MotionFault::Kind::joint_speed_limit, static_cast<int>(worst), speed[worst],
                     model_->velocity_max[worst]};
}

std::optional<MotionFault> PathMotion::advance_tcp(const TimeStep & time_step, Setpoint & setpoint)
{
  Transform pose = tcp_pose_at(kinematics_, segment_, segment_.profile.sample(clock_.time()).distance);
  if (!previous_finished()) {
    const Transform previous_pose =
        tcp_pose_at(kinematics_, previous_, previous_.profile.sample(previous_time()).distance);
    pose.translation() += previous_pose.translation() - start_tcp_.translation();
    pose.linear() = previous_pose.linear() * start_tcp_.linear().transpose() * pose.linear();
  }
  // The segment begins where the residual velocity has decayed.
  const Vector6 decayed = residual_.displacement(), total = residual_.total_displacement();
  pose.translation() += decayed.head<3>() - total.head<3>();
  pose.linear() =
      to_rotation_matrix(decayed.tail<3>()) * to_rotation_matrix(total.tail<3>()).transpose() * pose.linear();
  return kinematics_.move_to(pose, time_step.duration, setpoint);
}

void PathMotion::decelerate()
{
  const double speed = segment_.profile.sample(clock_.time()).speed;
  const double previous_speed = previous_finished() ? 0.0 : previous_.profile.sample(previous_time()).speed;
  clock_.decelerate(std::max(speed, previous_speed),
                    std::max(segment_.profile.acceleration(), min_takeover_deceleration));
}

}  // namespace ur_simulator
