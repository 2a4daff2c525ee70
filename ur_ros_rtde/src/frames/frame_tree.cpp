#include "ur_ros_rtde/detail/frame_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {
namespace {

double seconds(FrameTree::Clock::duration duration)
{
  return std::chrono::duration<double>(duration).count();
}

/// Empty: not finite, or without a rotation.
std::optional<Vector6> to_pose(const geometry_msgs::msg::Transform & transform)
{
  const auto & p = transform.translation;
  const auto & q = transform.rotation;
  const auto r = rotation_vector({q.x, q.y, q.z, q.w});
  const bool finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  return finite && r ? std::optional(Vector6{p.x, p.y, p.z, (*r)[0], (*r)[1], (*r)[2]}) : std::nullopt;
}

}  // namespace

void FrameTree::add(const geometry_msgs::msg::TransformStamped & transform,
                    std::optional<Clock::time_point> received)
{
  if (const auto pose = to_pose(transform.transform)) {
    links_[transform.child_frame_id] = {transform.header.frame_id, *pose, received};
  }
}

bool FrameTree::knows(const std::string & frame) const
{
  return links_.contains(frame) ||
         std::ranges::any_of(links_, [&](const auto & link) { return link.second.parent == frame; });
}

Expected<FrameTree::InRoot> FrameTree::in_root(const std::string & frame, Clock::time_point now) const
{
  InRoot result{frame, {}};
  for (std::size_t steps = 0; steps <= links_.size(); ++steps) {
    const auto found = links_.find(result.root);
    if (found == links_.end()) {
      return result;
    }
    const Link & link = found->second;
    if (link.received && now - *link.received > longest_age) {
      return failure(
          ErrorCode::invalid_goal,
          fmt::format("the transform from \"{}\" to \"{}\" was published {:.1f} s ago, the limit is "
                      "{} s",
                      link.parent, result.root, seconds(now - *link.received), longest_age.count()));
    }
    result = {link.parent, pose_trans(link.pose, result.pose)};
  }
  return failure(ErrorCode::invalid_goal, fmt::format("the frames above \"{}\" form a loop", frame));
}

Expected<Vector6> FrameTree::pose(const std::string & frame, const std::string & base,
                                  Clock::time_point now) const
{
  for (const std::string & name : {frame, base}) {
    if (!knows(name)) {
      return failure(ErrorCode::invalid_goal, fmt::format("TF has no frame \"{}\"", name));
    }
  }
  const auto target = in_root(frame, now);
  const auto origin = target ? in_root(base, now) : target;
  if (!origin) {
    return tl::unexpected(origin.error());
  }
  if (target->root != origin->root) {
    return failure(
        ErrorCode::invalid_goal,
        fmt::format("TF does not connect \"{}\" with \"{}\": their trees begin with \"{}\" and \"{}\"", frame,
                    base, target->root, origin->root));
  }
  return pose_trans(pose_inverse(origin->pose), target->pose);
}

}  // namespace ur_ros_rtde
