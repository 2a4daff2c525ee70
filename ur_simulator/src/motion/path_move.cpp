#include "motion/path_move.hpp"

#include <algorithm>

#include "common/pose.hpp"

namespace ur_simulator {
namespace {

bool is_joint(const PathLeg & leg)
{
  return std::holds_alternative<JointLeg>(leg.way);
}

}  // namespace

PathMove::PathMove(const RobotModel & model, const CartesianPath & path, const PathLeg & leg,
                   const Runout & runout)
    : model_(&model), path_(path), leg_(leg), start_tcp_(tcp_at(leg, 0.0)), runout_(runout)
{
}

PathMove::PathMove(const PathMove & before, const PathLeg & leg)
    : model_(before.model_),
      path_(before.path_),
      leg_(leg),
      start_tcp_(tcp_at(leg, 0.0)),
      blends_(true),
      before_(before.leg_),
      before_offset_(before.clock_.time())
{
}

Transform PathMove::tcp_at(const PathLeg & leg, double distance) const
{
  if (const auto * joints = std::get_if<JointLeg>(&leg.way)) {
    return path_.tcp(joints->at(distance));
  }
  return std::get<TcpLeg>(leg.way).at(distance);
}

Transform PathMove::target() const
{
  if (const auto * joints = std::get_if<JointLeg>(&leg_.way)) {
    return path_.tcp(joints->target());
  }
  return std::get<TcpLeg>(leg_.way).target();
}

bool PathMove::before_over() const
{
  return !blends_ || time_before() >= before_.profile.duration();
}

bool PathMove::released() const
{
  return done_ ||
         (advanced_ && before_over() && runout_.over() && clock_.time() >= leg_.profile.release_time());
}

bool PathMove::in_blend() const
{
  return !done_ && !clock_.braking() && released();
}

std::optional<MotionFault> PathMove::advance(const Tick & tick, Setpoint & now)
{
  advanced_ = true;
  runout_.advance(tick.duration);
  clock_.advance(tick.duration, tick.speed_scaling);
  const bool joints_only = is_joint(leg_) && (before_over() || is_joint(before_));
  const auto fault = joints_only ? advance_joints(tick, now) : advance_tcp(tick, now);
  if (fault) {
    return fault;
  }
  const bool arrived = before_over() && clock_.time() >= leg_.profile.duration();
  if (runout_.over() && (arrived || clock_.stopped())) {
    if (const auto * joints = std::get_if<JointLeg>(&leg_.way); joints != nullptr && arrived) {
      now.position = joints->target();
    }
    now.velocity.setZero();
    done_ = true;
  }
  return std::nullopt;
}

std::optional<MotionFault> PathMove::advance_joints(const Tick & tick, Setpoint & now)
{
  const auto & way = std::get<JointLeg>(leg_.way);
  const auto along = leg_.profile.at(clock_.time());
  const double rate = clock_.rate() * tick.speed_scaling;
  Setpoint next{way.at(along.distance) + runout_.displacement() - runout_.total(),
                runout_.velocity() + rate * along.speed * way.direction()};
  if (!before_over()) {
    const auto & way_before = std::get<JointLeg>(before_.way);
    const auto rest = before_.profile.at(time_before());
    next.position += way_before.at(rest.distance) - way_before.target();
    next.velocity += rate * rest.speed * way_before.direction();
  }
  if (const auto fault = leap(now, next.position, tick.duration)) {
    return fault;
  }
  now = next;
  return std::nullopt;
}

std::optional<MotionFault> PathMove::leap(const Setpoint & now, const Vector6 & next, double duration) const
{
  // After a blend with a motion of the TCP the joints must have come out in the posture of the joint motion.
  constexpr double more_than_any_motion = 3.0;
  Eigen::Index worst = 0;
  const Vector6 speed = (next - now.position).cwiseAbs() / duration;
  if (speed.cwiseQuotient(model_->velocity_max).maxCoeff(&worst) < more_than_any_motion) {
    return std::nullopt;
  }
  return MotionFault{MotionFault::Kind::joint_speed_limit, static_cast<int>(worst), speed[worst],
                     model_->velocity_max[worst]};
}

std::optional<MotionFault> PathMove::advance_tcp(const Tick & tick, Setpoint & now)
{
  Transform pose = tcp_at(leg_, leg_.profile.at(clock_.time()).distance);
  if (!before_over()) {
    const Transform rest = tcp_at(before_, before_.profile.at(time_before()).distance);
    pose.translation() += rest.translation() - start_tcp_.translation();
    pose.linear() = rest.linear() * start_tcp_.linear().transpose() * pose.linear();
  }
  // The leg begins where the velocity has run out.
  const Vector6 run = runout_.displacement(), total = runout_.total();
  pose.translation() += run.head<3>() - total.head<3>();
  pose.linear() = to_rotation(run.tail<3>()) * to_rotation(total.tail<3>()).transpose() * pose.linear();
  return path_.follow(pose, tick.duration, now);
}

void PathMove::brake()
{
  const double own = leg_.profile.at(clock_.time()).speed;
  const double rest = before_over() ? 0.0 : before_.profile.at(time_before()).speed;
  clock_.brake(std::max(own, rest), std::max(leg_.profile.acceleration(), takeover_deceleration));
}

}  // namespace ur_simulator
