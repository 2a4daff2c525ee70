#include "ur_ros_rtde_trajectory/sampled.hpp"

#include <algorithm>

#include "path/spline.hpp"
#include "timing/time_path.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

constexpr double same_sample = 1e-9;  // rad; closer samples are one

// A block without samples that repeat.
struct SampledKnots {
  std::vector<Joints> q;
  std::vector<double> width;     // rad, chords
  std::vector<double> shortest;  // s

  explicit SampledKnots(const SampledBlock & block) : q{block.positions.front()}
  {
    double time = 0.0;
    for (std::size_t i = 1; i < block.positions.size(); ++i) {
      time += block.shortest[i - 1];
      const double chord = (block.positions[i] - q.back()).matrix().norm();
      if (chord > same_sample) {
        q.push_back(block.positions[i]);
        width.push_back(chord);
        shortest.push_back(time);
        time = 0.0;
      }
    }
  }
};

void add_block(Path & path, const SampledKnots & knots)
{
  const auto slopes = natural_spline_slopes(knots.q, knots.width);
  for (std::size_t i = 0; i + 1 < knots.q.size(); ++i) {
    PathPiece piece;
    piece.start = path.length();
    piece.length = knots.width[i];
    piece.degree = 3;
    piece.top_speed = knots.shortest[i] > 0.0 ? knots.width[i] / knots.shortest[i] : unlimited;
    const Joints rise = knots.q[i + 1] - knots.q[i];
    const Joints m0 = slopes[i] * piece.length;
    const Joints m1 = slopes[i + 1] * piece.length;
    piece.c[0] = knots.q[i];
    piece.c[1] = m0;
    piece.c[2] = 3.0 * rise - 2.0 * m0 - m1;
    piece.c[3] = m0 + m1 - 2.0 * rise;
    path.pieces.push_back(piece);
  }
}

// The place of each sample, and where on the path it lies.
struct Places {
  std::vector<double> place, s;

  double on_path(double wanted) const
  {
    const auto after = std::upper_bound(place.begin(), place.end(), wanted);
    if (after == place.begin()) {
      return s.front();
    }
    if (after == place.end()) {
      return s.back();
    }
    const auto i = static_cast<std::size_t>(after - place.begin());
    const double part = (wanted - place[i - 1]) / (place[i] - place[i - 1]);
    return s[i - 1] + part * (s[i] - s[i - 1]);
  }
};

Places places_of(const std::vector<SampledBlock> & blocks)
{
  Places places;
  double s = 0.0;
  for (const SampledBlock & block : blocks) {
    for (std::size_t i = 0; i < block.positions.size(); ++i) {
      const double chord = i > 0 ? (block.positions[i] - block.positions[i - 1]).matrix().norm() : 0.0;
      s += chord;
      places.place.push_back(block.place[i]);
      places.s.push_back(s);
    }
  }
  return places;
}

}  // namespace

Expected<Trajectory> plan_sampled(const std::vector<SampledBlock> & blocks,
                                  const std::vector<double> & waypoints, const Limits & limits,
                                  const std::stop_token & stop)
{
  if (auto status = check(limits); !status) {
    return tl::unexpected(status.error());
  }
  auto path = std::make_shared<Path>();
  for (const SampledBlock & block : blocks) {
    const SampledKnots knots(block);
    if (knots.q.size() < 2) {
      continue;
    }
    if (!path->pieces.empty()) {
      path->stops.push_back(path->pieces.size());
    }
    add_block(*path, knots);
  }
  if (path->pieces.empty()) {
    path->pieces.emplace_back().c[0] = blocks.front().positions.front();
  }
  const Places places = places_of(blocks);
  for (const double waypoint : waypoints) {
    path->waypoints.push_back(std::min(places.on_path(waypoint), path->length()));
  }
  return time_path(std::move(path), limits, stop).map([](std::shared_ptr<Motion> motion) {
    return Trajectory(std::move(motion));
  });
}

}  // namespace ur_ros_rtde::trajectory
