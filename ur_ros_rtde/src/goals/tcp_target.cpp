#include "ur_ros_rtde/tcp_target.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double max_rotation_without_warning = std::numbers::pi / 2.0;  // rad

double rotation_angle(const Vector6 & from, const Vector6 & to)
{
  const Vector6 displacement = pose_trans(pose_inverse(from), to);
  return length(rotation(displacement));
}

Vector6 to_pose(const std::vector<double> & values)
{
  Vector6 pose;
  std::copy_n(values.begin(), pose.size(), pose.begin());
  return pose;
}
}  // namespace

bool has_identity_orientation(const geometry_msgs::msg::Pose & pose)
{
  const auto & q = pose.orientation;
  return q.x == 0.0 && q.y == 0.0 && q.z == 0.0 && q.w == 1.0;
}

std::vector<double> tcp_target(const geometry_msgs::msg::Pose & pose, bool identity_orientation,
                               const Sample & start)
{
  std::vector<double> target = to_ur(pose);
  if (has_identity_orientation(pose) && !identity_orientation) {
    std::copy_n(start.target_tcp_pose.begin() + 3, 3, target.begin() + 3);
  }
  return target;
}

std::vector<PathPose> path_poses(const std::string & field,
                                 const std::vector<geometry_msgs::msg::Pose> & poses)
{
  std::vector<PathPose> path;
  path.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    path.push_back({fmt::format("{}[{}]", field, i), poses[i]});
  }
  return path;
}

std::string identity_orientation_warning(const Vector6 & start, const std::vector<PathPose> & path)
{
  std::optional<Vector6> before = start;
  for (const PathPose & next : path) {
    const std::optional<Vector6> pose = next.pose ? std::optional(to_pose(to_ur(*next.pose))) : std::nullopt;
    const double angle = before && pose ? rotation_angle(*before, *pose) : 0.0;
    if (angle > max_rotation_without_warning && has_identity_orientation(*next.pose)) {
      return fmt::format(
          "{} turns the tool by {:.0f} degrees to the orientation (0, 0, 0, 1), the default of a pose "
          "message if only its position is given: set the orientation of each pose of a path",
          next.name, angle * 180.0 / std::numbers::pi);
    }
    before = pose;
  }
  return {};
}

void warn_of_identity_orientation(Run & run, const std::vector<PathPose> & path)
{
  if (const std::string warning = identity_orientation_warning(run.state().target_tcp_pose, path);
      !warning.empty()) {
    run.warn(warning);
  }
}

}  // namespace ur_ros_rtde
