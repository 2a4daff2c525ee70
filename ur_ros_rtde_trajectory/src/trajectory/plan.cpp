#include "ur_ros_rtde_trajectory/plan.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "motion/verify.hpp"
#include "path/path_builder.hpp"
#include "timing/time_parameterization.hpp"
#include "trajectory/check_positions.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

Status check_option(std::string_view field, double value, double low, double high, bool low_allowed)
{
  const bool fine = std::isfinite(value) && value <= high && (low_allowed ? value >= low : value > low);
  if (!fine) {
    return failure(ErrorCode::invalid_goal, fmt::format("{} is {}: give {} {} and at most {}", field, value,
                                                        low_allowed ? "at least" : "more than", low, high));
  }
  return {};
}

Status check(const PathOptions & options)
{
  if (auto status =
          check_option("blend_tolerance", options.blend_tolerance, 0.0, 2.0 * std::numbers::pi, true);
      !status) {
    return status;
  }
  if (auto status = check_option("corner_angle", options.corner_angle, 0.0, std::numbers::pi, true);
      !status) {
    return status;
  }
  return check_option("speed_fraction", options.speed_fraction, 0.0, 1.0, false);
}

Status check_count(std::size_t count)
{
  if (count == 0) {
    return failure(ErrorCode::invalid_goal, "waypoints is empty: give at least one waypoint");
  }
  if (count > max_waypoints) {
    return failure(ErrorCode::invalid_goal,
                   fmt::format("waypoints has {} entries, at most {} are possible: send the path in parts",
                               count, max_waypoints));
  }
  return {};
}

Status check_waypoints(const std::vector<Joints> & waypoints, const Limits & limits)
{
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    for (int j = 0; j < joint_count; ++j) {
      const double value = waypoints[i][j];
      if (!std::isfinite(value)) {
        return failure(
            ErrorCode::invalid_goal,
            fmt::format("waypoint {}: position of {} is {}: give a finite number", i, joint_name(j), value));
      }
    }
    if (auto status = check_positions(fmt::format("waypoint {}: position", i), waypoints[i], limits);
        !status) {
      return status;
    }
  }
  return {};
}

Expected<std::vector<Joints>> read_waypoints(std::span<const std::vector<double>> waypoints)
{
  if (auto status = check_count(waypoints.size()); !status) {
    return tl::unexpected(status.error());
  }
  std::vector<Joints> points;
  points.reserve(waypoints.size());
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const auto point = to_joints(fmt::format("waypoint {}", i), waypoints[i]);
    if (!point) {
      return tl::unexpected(point.error());
    }
    points.push_back(*point);
  }
  return points;
}

}  // namespace

Status check_path(std::span<const std::vector<double>> waypoints, const Limits & limits)
{
  const auto points = read_waypoints(waypoints);
  if (!points) {
    return tl::unexpected(points.error());
  }
  if (auto status = check(limits); !status) {
    return status;
  }
  return check_waypoints(*points, limits);
}

Expected<Trajectory> plan_path(std::span<const std::vector<double>> waypoints, const Limits & limits,
                               const PathOptions & options)
{
  const auto points = read_waypoints(waypoints);
  if (!points) {
    return tl::unexpected(points.error());
  }
  return plan_path(*points, limits, options);
}

Expected<Trajectory> plan_path(const std::vector<Joints> & waypoints, const Limits & limits,
                               const PathOptions & options)
{
  for (const Status & status : {check_count(waypoints.size()), check(limits), check(options)}) {
    if (!status) {
      return tl::unexpected(status.error());
    }
  }
  if (auto status = check_waypoints(waypoints, limits); !status) {
    return tl::unexpected(status.error());
  }
  auto path = std::make_shared<Path>(build_path(waypoints, {options.blend_tolerance, options.corner_angle}));
  auto motion = parameterize_path(std::move(path), limits, options.stop);
  if (!motion) {
    return tl::unexpected(motion.error());
  }
  if (options.speed_fraction < 1.0) {
    (*motion)->stretch(1.0 / options.speed_fraction);
  }
  if (Status possible = check_duration(**motion); !possible) {
    return tl::unexpected(possible.error());
  }
  return Trajectory(std::move(*motion));
}

}  // namespace ur_ros_rtde::trajectory
