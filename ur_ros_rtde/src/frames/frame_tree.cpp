#include "ur_ros_rtde/detail/frame_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {
namespace {

using std::chrono::seconds;

/// For a frame that is known since, or in, an older time than others.
constexpr seconds kept{3};
/// A frame that is no longer published is forgotten: detectors number what they see.
constexpr seconds forgotten_after{60};

double to_seconds(FrameTree::Clock::duration duration)
{
  return std::chrono::duration<double>(duration).count();
}

std::string without_slash(const std::string & frame)
{
  return frame.starts_with('/') ? frame.substr(1) : frame;
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

/// On the line from `a` to `b`, at `share` of it.
Vector6 between(const Vector6 & a, const Vector6 & b, double share)
{
  const Vector3 turned = rotation(pose_trans(pose_inverse(a), b));
  const Vector6 turn = pose_trans({0.0, 0.0, 0.0, a[3], a[4], a[5]},
                                  {0.0, 0.0, 0.0, share * turned[0], share * turned[1], share * turned[2]});
  Vector6 result = turn;
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = a[i] + share * (b[i] - a[i]);
  }
  return result;
}

}  // namespace

std::optional<Vector6> FrameTree::Link::at(Stamp stamp) const
{
  if (!received) {
    return poses.back().second;
  }
  const auto after = std::ranges::lower_bound(poses, stamp, {}, [](const auto & pose) { return pose.first; });
  if (after == poses.end() || (after == poses.begin() && after->first != stamp)) {
    return std::nullopt;
  }
  if (after->first == stamp) {
    return after->second;
  }
  const auto before = std::prev(after);
  const double share = to_seconds(stamp - before->first) / to_seconds(after->first - before->first);
  return between(before->second, after->second, share);
}

void FrameTree::add(const geometry_msgs::msg::TransformStamped & transform,
                    std::optional<Clock::time_point> received)
{
  const auto & header = transform.header;
  const std::string child = without_slash(transform.child_frame_id);
  const std::string parent = without_slash(header.frame_id);
  const auto pose = to_pose(transform.transform);
  if (!pose || child == parent) {
    return;
  }
  const Stamp stamp = seconds(header.stamp.sec) + std::chrono::nanoseconds(header.stamp.nanosec);
  const bool is_known = links_.contains(child);
  if (!is_known && received) {
    forget_lost(*received);
  }
  Link & link = links_[child];
  const bool continues = is_known && received && link.received && link.parent == parent &&
                         !link.poses.empty() && stamp >= link.poses.front().first;
  if (!continues) {
    link.poses.clear();  // static, the first one, of another parent, or the clock was set back
  } else if (stamp < link.poses.back().first) {
    return;
  } else if (stamp == link.poses.back().first) {
    link.poses.pop_back();
  }
  link.parent = parent;
  link.received = received;
  link.poses.emplace_back(stamp, *pose);
  while (stamp - link.poses.front().first > kept) {
    link.poses.pop_front();
  }
}

void FrameTree::forget_lost(Clock::time_point now)
{
  std::erase_if(links_, [now](const auto & link) {
    return link.second.received && now - *link.second.received > forgotten_after;
  });
}

bool FrameTree::knows(const std::string & frame) const
{
  return links_.contains(frame) ||
         std::ranges::any_of(links_, [&](const auto & link) { return link.second.parent == frame; });
}

Expected<FrameTree::Way> FrameTree::way(const std::string & frame, Clock::time_point now) const
{
  Way result{{}, frame};
  while (result.links.size() <= links_.size()) {
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
                      link.parent, result.root, to_seconds(now - *link.received), longest_age.count()));
    }
    result.links.push_back(found);
    result.root = link.parent;
  }
  return failure(ErrorCode::invalid_goal, fmt::format("the frames above \"{}\" form a loop", frame));
}

FrameTree::Stamp FrameTree::Way::newest() const
{
  Stamp result = Stamp::max();
  for (const auto & link : links) {
    result = link->second.received ? std::min(result, link->second.poses.back().first) : result;
  }
  return result;
}

tl::expected<Vector6, std::string> FrameTree::Way::pose_in_root(Stamp stamp) const
{
  Vector6 result{};
  for (const auto & link : links) {
    const auto pose = link->second.at(stamp);
    if (!pose) {
      return tl::make_unexpected(link->first);
    }
    result = pose_trans(*pose, result);
  }
  return result;
}

Expected<Vector6> FrameTree::pose(const std::string & frame, const std::string & base,
                                  Clock::time_point now) const
{
  for (const std::string & name : {frame, base}) {
    if (!knows(name)) {
      return failure(ErrorCode::invalid_goal, fmt::format("TF has no frame \"{}\"", name));
    }
  }
  const auto target = way(frame, now);
  const auto origin = target ? way(base, now) : target;
  if (!origin) {
    return tl::unexpected(origin.error());
  }
  if (target->root != origin->root) {
    return failure(
        ErrorCode::invalid_goal,
        fmt::format("TF does not connect \"{}\" with \"{}\": their trees begin with \"{}\" and \"{}\"", frame,
                    base, target->root, origin->root));
  }
  const Stamp common = std::min(target->newest(), origin->newest());
  const auto target_in_root = target->pose_in_root(common);
  const auto base_in_root = origin->pose_in_root(common);
  if (!target_in_root || !base_in_root) {
    return failure(ErrorCode::invalid_goal,
                   fmt::format("TF does not tell where \"{}\" was when the other frames on the way from "
                               "\"{}\" to \"{}\" were seen last",
                               target_in_root ? base_in_root.error() : target_in_root.error(), base, frame));
  }
  return pose_trans(pose_inverse(*base_in_root), *target_in_root);
}

}  // namespace ur_ros_rtde
