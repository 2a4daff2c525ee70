#include "streaming/goal_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

namespace ur_ros_rtde {
namespace {

using Values = std::vector<double>;
using Points = std::vector<trajectory_msgs::msg::JointTrajectoryPoint>;

bool ends_with(std::string_view text, std::string_view end)
{
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

double seconds(const builtin_interfaces::msg::Duration & duration)
{
  return static_cast<double>(duration.sec) + 1e-9 * static_cast<double>(duration.nanosec);
}

/// One field of all points in the joint order of UR. Empty if it is empty in all points.
Expected<std::vector<Values>> read_list(const Points & points, const std::array<std::size_t, 6> & order,
                                        std::string_view name,
                                        Values trajectory_msgs::msg::JointTrajectoryPoint::* field)
{
  std::vector<Values> lists;
  const bool given = !(points.front().*field).empty();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Values & values = points[i].*field;
    if (values.empty() && !given) {
      continue;
    }
    if (values.size() != order.size()) {
      return failure(ErrorCode::invalid_goal,
                     fmt::format("points[{}].{} has {} values, points[0].{} has {}: set 6 values in every "
                                 "point, or none in all points",
                                 i, name, values.size(), name, (points.front().*field).size()));
    }
    Values sorted(order.size());
    std::transform(order.begin(), order.end(), sorted.begin(),
                   [&values](std::size_t place) { return values[place]; });
    lists.push_back(std::move(sorted));
  }
  return lists;
}

}  // namespace

void require(Check & check, const Status & status)
{
  if (!status) {
    check.that(false, status.error().message, status.error().code);
  }
}

void check_limits(Check & check, std::string_view field, const std::vector<double> & values,
                  const trajectory::Joints & max, std::string_view unit)
{
  check.that(
      values.empty() || values.size() == 6,
      fmt::format("{} has {} values: set 6, one per joint, or none for the defaults", field, values.size()));
  for (std::size_t i = 0; i < values.size() && check.ok(); ++i) {
    check.above_zero(fmt::format("{}[{}] ({})", field, i, joint_names()[i]), values[i],
                     max[static_cast<int>(i)], unit);
  }
}

Expected<std::array<std::size_t, 6>> joint_order(const std::vector<std::string> & names)
{
  std::array<std::size_t, 6> order{0, 1, 2, 3, 4, 5};
  if (names.empty()) {
    return order;
  }
  if (names.size() != 6) {
    return failure(ErrorCode::invalid_goal, fmt::format("joint_names has {} names, the arm has 6 joints: {}",
                                                        names.size(), fmt::join(joint_names(), ", ")));
  }
  std::set<std::string_view> prefixes;
  for (std::size_t joint = 0; joint < 6; ++joint) {
    const std::string & wanted = joint_names()[joint];
    const auto found = std::find_if(names.begin(), names.end(),
                                    [&wanted](const std::string & name) { return ends_with(name, wanted); });
    if (found == names.end()) {
      return failure(ErrorCode::invalid_goal,
                     fmt::format("joint_names has no {}: it has {}", wanted, fmt::join(names, ", ")));
    }
    order[joint] = static_cast<std::size_t>(found - names.begin());
    prefixes.insert(std::string_view(*found).substr(0, found->size() - wanted.size()));
  }
  if (prefixes.size() != 1) {
    return failure(ErrorCode::invalid_goal,
                   fmt::format("joint_names belong to several arms, their prefixes are \"{}\"",
                               fmt::join(prefixes, "\", \"")));
  }
  return order;
}

Expected<trajectory::TimedWaypoints> timed_waypoints(const trajectory_msgs::msg::JointTrajectory & message)
{
  using Point = trajectory_msgs::msg::JointTrajectoryPoint;
  const auto order = joint_order(message.joint_names);
  if (!order) {
    return tl::unexpected(order.error());
  }
  if (message.points.empty()) {
    return failure(ErrorCode::invalid_goal, "points is empty: set at least one");
  }
  trajectory::TimedWaypoints waypoints;
  for (const Point & point : message.points) {
    waypoints.times.push_back(seconds(point.time_from_start));
  }
  for (const auto & [list, name, field] :
       {std::tuple{&waypoints.positions, "positions", &Point::positions},
        std::tuple{&waypoints.velocities, "velocities", &Point::velocities},
        std::tuple{&waypoints.accelerations, "accelerations", &Point::accelerations}}) {
    auto read = read_list(message.points, *order, name, field);
    if (!read) {
      return tl::unexpected(read.error());
    }
    *list = std::move(*read);
  }
  if (waypoints.positions.empty()) {
    return failure(ErrorCode::invalid_goal, "points[0].positions has 0 values, it must have 6");
  }
  trajectory::drop_close_waypoints(waypoints);
  return waypoints;
}

}  // namespace ur_ros_rtde
