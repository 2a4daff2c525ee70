#include "ur_ros_rtde_trajectory/cartesian.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "kinematics/cartesian_sampler.hpp"
#include "kinematics/displacement_norm.hpp"

namespace ur_ros_rtde::kinematics {
namespace {

using trajectory::SampledSegment;
using trajectory::Trajectory;

constexpr std::size_t max_ik_queries = 100;
constexpr double same_correction = 1e-5;   // m
constexpr double max_model_error = 0.015;  // m; a larger deviation means another arm

Status check_range(std::string_view field, double value, bool may_be_zero)
{
  const bool valid = std::isfinite(value) && (may_be_zero ? value >= 0.0 : value > 0.0);
  return valid ? Status()
               : failure(ErrorCode::invalid_goal,
                         fmt::format("{} is {:.6g}: it must be a finite number {} 0", field, value,
                                     may_be_zero ? "of at least" : "above"));
}

Status check_finite(const std::vector<Pose> & poses, const Joints & start)
{
  if (poses.empty()) {
    return failure(ErrorCode::invalid_goal, "poses is empty: the first is where the arm is");
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!poses[i].matrix().allFinite()) {
      return failure(ErrorCode::invalid_goal, fmt::format("poses[{}] has numbers that are not finite", i));
    }
  }
  return start.allFinite() ? Status()
                           : failure(ErrorCode::invalid_goal, "start has numbers that are not finite");
}

/// Joint positions at path parameter u of segments that were sampled with the correction of the start only.
Joints joints_at(const std::vector<SampledSegment> & segments, double u)
{
  for (const SampledSegment & segment : segments) {
    const auto after = std::lower_bound(segment.parameters.begin(), segment.parameters.end(), u);
    if (after != segment.parameters.end()) {
      return segment.positions[static_cast<std::size_t>(after - segment.parameters.begin())];
    }
  }
  return segments.back().positions.back();
}

/// Queries the inverse kinematics at the poses. Returns the deviation of the nominal kinematics from it.
Expected<KinematicCorrection> query_correction(const TcpPath & path, const Arm & arm,
                                               const std::vector<SampledSegment> & segments,
                                               const Twist & start_correction, const IkFunction & ik,
                                               const std::stop_token & stop)
{
  KinematicCorrection correction;
  correction.add(0.0, start_correction);
  const auto & waypoints = path.waypoints();
  const std::size_t stride = (waypoints.size() + max_ik_queries - 1) / max_ik_queries;
  double last = 0.0;
  for (std::size_t i = (waypoints.size() - 1) % stride; i < waypoints.size(); i += stride) {
    if (stop.stop_requested()) {
      return failure(ErrorCode::canceled, "planning was canceled");
    }
    if (waypoints[i] <= last) {
      continue;
    }
    last = waypoints[i];
    const Pose pose = path.at(waypoints[i]);
    const Joints guess = joints_at(segments, waypoints[i]);
    const auto q = ik(pose, guess);
    if (!q) {
      return tl::unexpected(q.error());
    }
    const Twist error = difference(pose, arm.forward(*q));
    if (displacement_norm(error) > max_model_error) {
      return failure(
          ErrorCode::not_supported,
          fmt::format("the controller's inverse kinematics for poses[{}] deviate by {:.1f} mm from the "
                      "nominal kinematics of the arm: plan in joint space instead",
                      i - 1, 1e3 * displacement_norm(error)));
    }
    correction.add(waypoints[i], error);
  }
  return correction;
}

}  // namespace

Expected<Trajectory> plan_cartesian(const std::vector<Pose> & poses, const Arm & arm, const Joints & start,
                                    const trajectory::Limits & limits, const CartesianOptions & options,
                                    const IkFunction & ik, const std::stop_token & stop)
{
  for (const Status & status : {check_finite(poses, start), check_range("speed", options.speed, false),
                                check_range("rotation_speed", options.rotation_speed, false),
                                check_range("blend_radius", options.blend_radius, true)}) {
    if (!status) {
      return tl::unexpected(status.error());
    }
  }
  const TcpPath path(poses, options.blend_radius);
  const CartesianSampler sampler(path, arm, limits, options);
  const Twist start_correction = difference(poses.front(), arm.forward(start));
  KinematicCorrection correction;
  correction.add(0.0, start_correction);
  auto segments = sampler.sample_path(start, correction, stop);
  if (!segments) {
    return tl::unexpected(segments.error());
  }
  const auto correction_at_waypoints = query_correction(path, arm, *segments, start_correction, ik, stop);
  if (!correction_at_waypoints) {
    return tl::unexpected(correction_at_waypoints.error());
  }
  const auto & waypoints = path.waypoints();
  const bool differs = std::any_of(waypoints.begin(), waypoints.end(), [&](double u) {
    return displacement_norm(correction_at_waypoints->at(u) - start_correction) > same_correction;
  });
  if (differs) {
    segments = sampler.sample_path(start, *correction_at_waypoints, stop);
  }
  if (!segments) {
    return tl::unexpected(segments.error());
  }
  return trajectory::plan_sampled(*segments, waypoints, limits, stop);
}

}  // namespace ur_ros_rtde::kinematics
