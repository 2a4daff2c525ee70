#include "common/pose.hpp"
#include "kinematics/forward.hpp"
#include "motion/arm_impl.hpp"
#include "motion/path_planner.hpp"

namespace ur_simulator {
namespace {

Refusal no_fraction(std::string_view call, const MoveOptions & options)
{
  const auto beyond = [&](std::string_view field, double value) -> Refusal {
    return value > 0.0 && value <= 1.0
               ? std::nullopt
               : Refusal(fmt::format("{}: {} must be in (0, 1], is {}", call, field, value));
  };
  return first_of({beyond("a", options.acceleration), beyond("v", options.velocity)});
}

}  // namespace

PathPlanner Arm::Impl::planner(const CartesianPath & path)
{
  const auto * before = given_up ? nullptr : std::get_if<PathMove>(&slot);
  const bool blends = before != nullptr && before->in_blend() && before->path().same_tool(path);
  return {model, path, setpoint, cycle_time, blends ? before : nullptr};
}

template <typename Lay>
MotionStart Arm::Impl::begin_path(const Transform & target, double blend_radius, Lay lay)
{
  const CartesianPath tool = path();
  const PathPlanner laid = planner(tool);
  if (laid.overlaps(target, blend_radius)) {
    return skipped_motion;
  }
  return begin(lay(laid));
}

MotionStart Arm::move_joint(const Vector6 & target, const MoveOptions & options)
{
  if (const auto refusal =
          first_of({impl_->not_ready("movej"), not_finite("movej", "target", target),
                    bad_options("movej", options), beyond_joint_limits("movej", impl_->model, target)})) {
    return tl::unexpected(*refusal);
  }
  return impl_->begin_path(impl_->path().tcp(target), options.blend_radius,
                           [&](const PathPlanner & planner) { return planner.joint(target, options); });
}

MotionStart Arm::move_joint_optimally(const Vector6 & target, const MoveOptions & options)
{
  if (const auto refusal = first_of({impl_->not_ready("optimovej"), not_finite("optimovej", "goal", target),
                                     no_fraction("optimovej", options), bad_options("optimovej", options),
                                     beyond_joint_limits("optimovej", impl_->model, target)})) {
    return tl::unexpected(*refusal);
  }
  return impl_->begin_path(impl_->path().tcp(target), options.blend_radius, [&](const PathPlanner & planner) {
    return planner.optimal_joint(target, options);
  });
}

Refusal Arm::Impl::no_cartesian(std::string_view call, const Vector6 & pose,
                                const MoveOptions & options) const
{
  if (auto refusal =
          first_of({not_ready(call), not_finite(call, "pose", pose), bad_options(call, options)})) {
    return refusal;
  }
  return unreachable(call, pose);
}

MotionStart Arm::move_linear(const Vector6 & tcp_pose, const MoveOptions & options)
{
  if (const auto refusal = impl_->no_cartesian("movel", tcp_pose, options)) {
    return tl::unexpected(*refusal);
  }
  const Transform target = to_transform(tcp_pose);
  return impl_->begin_path(target, options.blend_radius,
                           [&](const PathPlanner & planner) { return planner.line(target, options); });
}

MotionStart Arm::move_linear_optimally(const Vector6 & tcp_pose, const MoveOptions & options)
{
  if (const auto refusal = first_of(
          {no_fraction("optimovel", options), impl_->no_cartesian("optimovel", tcp_pose, options)})) {
    return tl::unexpected(*refusal);
  }
  const Transform target = to_transform(tcp_pose);
  return impl_->begin_path(target, options.blend_radius, [&](const PathPlanner & planner) {
    return planner.optimal_line(target, options);
  });
}

MotionStart Arm::move_process(const Vector6 & tcp_pose, const MoveOptions & options)
{
  if (const auto refusal = impl_->no_cartesian("movep", tcp_pose, options)) {
    return tl::unexpected(*refusal);
  }
  const Transform target = to_transform(tcp_pose);
  return impl_->begin_path(target, options.blend_radius,
                           [&](const PathPlanner & planner) { return planner.process(target, options); });
}

MotionStart Arm::move_circular(const Vector6 & via, const Vector6 & tcp_pose, CircleMode mode,
                               const MoveOptions & options)
{
  if (const auto refusal =
          first_of({not_finite("movec", "pose_via", via), impl_->no_cartesian("movec", tcp_pose, options)})) {
    return tl::unexpected(*refusal);
  }
  const Transform target = to_transform(tcp_pose);
  const CartesianPath tool = impl_->path();
  const PathPlanner planner = impl_->planner(tool);
  if (planner.overlaps(target, options.blend_radius)) {
    return skipped_motion;
  }
  auto circle = planner.circle(via.head<3>(), target, mode, options);
  if (!circle) {
    const Vector6 from = to_pose(planner.start());
    return tl::unexpected(fmt::format(
        "movec: no circle leads from ({:.4f}, {:.4f}, {:.4f}) through pose_via ({:.4f}, {:.4f}, {:.4f}) to "
        "pose_to ({:.4f}, {:.4f}, {:.4f}): the three points must not lie on one line",
        from[0], from[1], from[2], via[0], via[1], via[2], tcp_pose[0], tcp_pose[1], tcp_pose[2]));
  }
  if (const auto refusal = impl_->unreachable("movec", to_pose(circle->target()))) {
    return tl::unexpected(*refusal);
  }
  return impl_->begin(std::move(*circle));
}

MotionStart Arm::servo_circular(const Vector6 & tcp_pose, const MoveOptions & options)
{
  if (const auto refusal = impl_->no_cartesian("servoc", tcp_pose, options)) {
    return tl::unexpected(*refusal);
  }
  const CartesianPath tool = impl_->path();
  return impl_->begin(impl_->planner(tool).servo_circle(to_transform(tcp_pose), options));
}

bool Arm::in_blend(MotionId motion) const
{
  const auto * path = std::get_if<PathMove>(&impl_->slot);
  return motion == impl_->last_id && path != nullptr && !impl_->given_up && path->in_blend();
}

bool Arm::arrived(MotionId motion) const
{
  return motion == impl_->last_arrived;
}

std::optional<Arm::PathEnds> Arm::path_ends() const
{
  const auto * path = std::get_if<PathMove>(&impl_->slot);
  return path != nullptr ? std::optional(PathEnds{to_pose(path->start()), to_pose(path->target())})
                         : std::nullopt;
}

}  // namespace ur_simulator
