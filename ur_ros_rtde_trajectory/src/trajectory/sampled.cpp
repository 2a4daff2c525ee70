#include "ur_ros_rtde_trajectory/sampled.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "path/spline.hpp"
#include "timing/time_parameterization.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

constexpr double same_sample = 1e-9;  // rad; closer samples are merged

Status check(const SampledSegment & segment, std::size_t number)
{
  const std::size_t count = segment.positions.size();
  if (count == 0 || segment.parameters.size() != count || segment.min_durations.size() != count - 1) {
    return failure(
        ErrorCode::invalid_goal,
        fmt::format("segment {} has {} positions, {} parameters and {} durations: give at least one "
                    "position, a parameter for each, and a duration for each interval",
                    number, count, segment.parameters.size(), segment.min_durations.size()));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const bool follows = i == 0 || segment.parameters[i] > segment.parameters[i - 1];
    const bool has_duration =
        i == 0 || (segment.min_durations[i - 1] >= 0.0 && std::isfinite(segment.min_durations[i - 1]));
    if (!segment.positions[i].allFinite() || !std::isfinite(segment.parameters[i]) || !follows ||
        !has_duration) {
      return failure(
          ErrorCode::invalid_goal,
          fmt::format("sample {} of segment {} is invalid: give finite positions, increasing finite "
                      "parameters, and durations of 0 s or more",
                      i, number));
    }
  }
  return {};
}

Status check(const std::vector<SampledSegment> & segments)
{
  if (segments.empty()) {
    return failure(ErrorCode::invalid_goal, "there is no segment: give at least one");
  }
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (Status valid = check(segments[i], i); !valid) {
      return valid;
    }
  }
  return {};
}

// Knots of a segment, without repeated samples.
struct SampledKnots {
  std::vector<Joints> q;
  std::vector<double> width;         // rad, chord lengths
  std::vector<double> min_duration;  // s

  explicit SampledKnots(const SampledSegment & segment) : q{segment.positions.front()}
  {
    double time = 0.0;
    for (std::size_t i = 1; i < segment.positions.size(); ++i) {
      time += segment.min_durations[i - 1];
      const double chord = (segment.positions[i] - q.back()).matrix().norm();
      if (chord > same_sample) {
        q.push_back(segment.positions[i]);
        width.push_back(chord);
        min_duration.push_back(time);
        time = 0.0;
      }
    }
  }
};

void add_segment(Path & path, const SampledKnots & knots)
{
  const auto slopes = natural_spline_slopes(knots.q, knots.width);
  for (std::size_t i = 0; i + 1 < knots.q.size(); ++i) {
    PathPiece piece = cubic_piece(knots.q[i], knots.q[i + 1], slopes[i], slopes[i + 1], knots.width[i]);
    piece.start = path.length();
    piece.max_speed = knots.min_duration[i] > 0.0 ? knots.width[i] / knots.min_duration[i] : unlimited;
    path.pieces.push_back(piece);
  }
}

// Maps the path parameters of the caller to the arc length s of the path.
struct ParameterMap {
  std::vector<double> parameter, s;

  double path_position(double at) const
  {
    const auto after = std::upper_bound(parameter.begin(), parameter.end(), at);
    if (after == parameter.begin()) {
      return s.front();
    }
    if (after == parameter.end()) {
      return s.back();
    }
    const auto i = static_cast<std::size_t>(after - parameter.begin());
    const double fraction = (at - parameter[i - 1]) / (parameter[i] - parameter[i - 1]);
    return s[i - 1] + fraction * (s[i] - s[i - 1]);
  }
};

ParameterMap parameter_map_of(const std::vector<SampledSegment> & segments)
{
  ParameterMap parameter_map;
  double s = 0.0;
  for (const SampledSegment & segment : segments) {
    for (std::size_t i = 0; i < segment.positions.size(); ++i) {
      const double chord = i > 0 ? (segment.positions[i] - segment.positions[i - 1]).matrix().norm() : 0.0;
      s += chord;
      parameter_map.parameter.push_back(segment.parameters[i]);
      parameter_map.s.push_back(s);
    }
  }
  return parameter_map;
}

}  // namespace

Expected<Trajectory> plan_sampled(const std::vector<SampledSegment> & segments,
                                  const std::vector<double> & waypoints, const Limits & limits,
                                  const std::stop_token & stop)
{
  for (const Status & status : {check(limits), check(segments)}) {
    if (!status) {
      return tl::unexpected(status.error());
    }
  }
  auto path = std::make_shared<Path>();
  for (const SampledSegment & segment : segments) {
    const SampledKnots knots(segment);
    if (knots.q.size() < 2) {
      continue;
    }
    if (!path->pieces.empty()) {
      path->stops.push_back(path->pieces.size());
    }
    add_segment(*path, knots);
  }
  if (path->pieces.empty()) {
    path->pieces.emplace_back().c[0] = segments.front().positions.front();
  }
  const ParameterMap parameter_map = parameter_map_of(segments);
  for (const double waypoint : waypoints) {
    path->waypoints.push_back(std::min(parameter_map.path_position(waypoint), path->length()));
  }
  return parameterize_path(std::move(path), limits, stop).map([](std::shared_ptr<Motion> motion) {
    return Trajectory(std::move(motion));
  });
}

}  // namespace ur_ros_rtde::trajectory
