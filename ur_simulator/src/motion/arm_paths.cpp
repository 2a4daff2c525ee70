#include "common/pose.hpp"
#include "kinematics/forward_kinematics.hpp"
#include "motion/arm_impl.hpp"
#include "motion/path/path_planner.hpp"

namespace ur_simulator {
namespace {

Rejection check_fractions(std::string_view function, const MoveOptions & options)
{
  const auto check = [&](std::string_view argument, double value) -> Rejection {
    return value > 0.0 && value <= 1.0
               ? std::nullopt
               : Rejection(fmt::format("{}: {} must be in (0, 1], is {}", function, argument, value));
  };
  return first_rejection({check("a", options.acceleration), check("v", options.velocity)});
}

}  // namespace

PathPlanner Arm::Impl::make_planner(const TcpKinematics & kinematics)
{
  const auto * previous = canceled ? nullptr : std::get_if<PathMotion>(&active_motion);
  const bool blends =
      previous != nullptr && previous->in_blend() && previous->kinematics().has_same_tool(kinematics);
  return {model, kinematics, setpoint, cycle_time, blends ? previous : nullptr};
}

template <typename Plan>
StartResult Arm::Impl::start_path(const Transform & target, double blend_radius, Plan plan)
{
  const TcpKinematics kinematics = tcp_kinematics();
  const PathPlanner planner = make_planner(kinematics);
  if (planner.overlaps(target, blend_radius)) {
    return skipped_motion_id;
  }
  lapses.moves_from_motion += moves() && !planner.blends() ? 1 : 0;
  return start_motion(plan(planner));
}

StartResult Arm::move_joint(const Vector6 & target, const MoveOptions & options)
{
  if (const auto rejection = first_rejection(
          {impl_->check_ready("movej"), check_finite("movej", "target", target),
           check_move_options("movej", options), check_joint_limits("movej", impl_->model, target)})) {
    return tl::unexpected(*rejection);
  }
  return impl_->start_path(impl_->tcp_kinematics().tcp_pose(target), options.blend_radius,
                           [&](const PathPlanner & planner) { return planner.plan_joint(target, options); });
}

StartResult Arm::move_joint_optimally(const Vector6 & target, const MoveOptions & options)
{
  if (const auto rejection =
          first_rejection({impl_->check_ready("optimovej"), check_finite("optimovej", "goal", target),
                           check_fractions("optimovej", options), check_move_options("optimovej", options),
                           check_joint_limits("optimovej", impl_->model, target)})) {
    return tl::unexpected(*rejection);
  }
  return impl_->start_path(
      impl_->tcp_kinematics().tcp_pose(target), options.blend_radius,
      [&](const PathPlanner & planner) { return planner.plan_optimal_joint(target, options); });
}

Rejection Arm::Impl::check_cartesian_target(std::string_view function, const Vector6 & pose,
                                            const MoveOptions & options) const
{
  if (auto rejection = first_rejection({check_ready(function), check_finite(function, "pose", pose),
                                        check_move_options(function, options)})) {
    return rejection;
  }
  return check_reachable(function, pose);
}

StartResult Arm::move_linear(const Vector6 & tcp_pose, const MoveOptions & options)
{
  if (const auto rejection = impl_->check_cartesian_target("movel", tcp_pose, options)) {
    return tl::unexpected(*rejection);
  }
  const Transform target = to_transform(tcp_pose);
  return impl_->start_path(target, options.blend_radius,
                           [&](const PathPlanner & planner) { return planner.plan_line(target, options); });
}

StartResult Arm::move_linear_optimally(const Vector6 & tcp_pose, const MoveOptions & options)
{
  if (const auto rejection =
          first_rejection({check_fractions("optimovel", options),
                           impl_->check_cartesian_target("optimovel", tcp_pose, options)})) {
    return tl::unexpected(*rejection);
  }
  const Transform target = to_transform(tcp_pose);
  return impl_->start_path(target, options.blend_radius, [&](const PathPlanner & planner) {
    return planner.plan_optimal_line(target, options);
  });
}

StartResult Arm::move_process(const Vector6 & tcp_pose, const MoveOptions & options)
{
  if (const auto rejection = impl_->check_cartesian_target("movep", tcp_pose, options)) {
    return tl::unexpected(*rejection);
  }
  const Transform target = to_transform(tcp_pose);
  return impl_->start_path(target, options.blend_radius, [&](const PathPlanner & planner) {
    return planner.plan_process(target, options);
  });
}

StartResult Arm::move_circular(const Vector6 & via, const Vector6 & tcp_pose, CircleMode mode,
                               const MoveOptions & options)
{
  if (const auto rejection = first_rejection({check_finite("movec", "pose_via", via),
                                              impl_->check_cartesian_target("movec", tcp_pose, options)})) {
    return tl::unexpected(*rejection);
  }
  const Transform target = to_transform(tcp_pose);
  const TcpKinematics kinematics = impl_->tcp_kinematics();
  const PathPlanner planner = impl_->make_planner(kinematics);
  if (planner.overlaps(target, options.blend_radius)) {
    return skipped_motion_id;
  }
  auto circle = planner.plan_circle(via.head<3>(), target, mode, options);
  if (!circle) {
    const Vector6 from = to_pose(planner.start());
    return tl::unexpected(fmt::format(
        "movec: no circle leads from ({:.4f}, {:.4f}, {:.4f}) through pose_via ({:.4f}, {:.4f}, {:.4f}) to "
        "pose_to ({:.4f}, {:.4f}, {:.4f}): the three points must not lie on one line",
        from[0], from[1], from[2], via[0], via[1], via[2], tcp_pose[0], tcp_pose[1], tcp_pose[2]));
  }
  if (const auto rejection = impl_->check_reachable("movec", to_pose(circle->target()))) {
    return tl::unexpected(*rejection);
  }
  return impl_->start_motion(std::move(*circle));
}

StartResult Arm::servo_circular(const Vector6 & tcp_pose, const MoveOptions & options)
{
  if (const auto rejection = impl_->check_cartesian_target("servoc", tcp_pose, options)) {
    return tl::unexpected(*rejection);
  }
  const TcpKinematics kinematics = impl_->tcp_kinematics();
  return impl_->start_motion(
      impl_->make_planner(kinematics).plan_servo_circle(to_transform(tcp_pose), options));
}

bool Arm::in_blend(MotionId motion) const
{
  const auto * path = std::get_if<PathMotion>(&impl_->active_motion);
  return motion == impl_->last_id && path != nullptr && !impl_->canceled && path->in_blend();
}

bool Arm::reached_target(MotionId motion) const
{
  return motion == impl_->last_reached_id;
}

std::optional<Arm::PathEndpoints> Arm::path_endpoints() const
{
  const auto * path = std::get_if<PathMotion>(&impl_->active_motion);
  return path != nullptr ? std::optional(PathEndpoints{to_pose(path->start()), to_pose(path->target())})
                         : std::nullopt;
}

}  // namespace ur_simulator
