#include "common/segment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace ur_simulator {
namespace {

constexpr double tiny = 1e-18;  // m^2: shorter segments are points

/// The part of a position that lies outside of the box.
Vector3 excess(const Vector3 & position, const Vector3 & half_size)
{
  return position - position.cwiseMax(-half_size).cwiseMin(half_size);
}

/// Where a segment crosses the planes of the faces of a box, as fractions of its length; and its ends.
struct Crossings {
  std::array<double, 8> fractions{0.0, 1.0};
  std::size_t count = 2;
};

Crossings crossings(const Segment & segment, const Vector3 & half_size)
{
  Crossings result;
  const Vector3 direction = segment.end - segment.begin;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (const double face : {-half_size[i], half_size[i]}) {
      const double fraction = (face - segment.begin[i]) / direction[i];  // not finite if parallel
      if (fraction > 0.0 && fraction < 1.0) {
        result.fractions[result.count++] = fraction;
      }
    }
  }
  std::sort(result.fractions.begin(), result.fractions.begin() + static_cast<std::ptrdiff_t>(result.count));
  return result;
}

}  // namespace

double distance(const Segment & a, const Segment & b)
{
  // Minimizes |a(s) - b(t)|: the nearest points of the lines, then of the segments.
  const Vector3 u = a.end - a.begin;
  const Vector3 v = b.end - b.begin;
  const Vector3 offset = a.begin - b.begin;
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double uv = u.dot(v);
  const double uo = u.dot(offset);
  const double vo = v.dot(offset);
  const auto nearest_on_a = [&](double t) {
    return uu < tiny ? 0.0 : std::clamp((uv * t - uo) / uu, 0.0, 1.0);
  };
  const double determinant = uu * vv - uv * uv;
  double s = determinant > 1e-12 * uu * vv ? std::clamp((uv * vo - vv * uo) / determinant, 0.0, 1.0) : 0.0;
  const double t = vv < tiny ? 0.0 : std::clamp((uv * s + vo) / vv, 0.0, 1.0);
  s = nearest_on_a(t);
  return (offset + s * u - t * v).norm();
}

double distance_from_box(const Segment & segment, const Vector3 & half_size)
{
  // The squared distance of a point on the segment is a convex function of its position. Its derivative is
  // linear between the crossings.
  const Vector3 direction = segment.end - segment.begin;
  const auto position = [&](double fraction) -> Vector3 { return segment.begin + fraction * direction; };
  const auto slope = [&](double fraction) { return direction.dot(excess(position(fraction), half_size)); };
  const Crossings at = crossings(segment, half_size);
  double nearest = 0.0;
  double previous = slope(0.0);
  for (std::size_t i = 1; i < at.count && previous < 0.0; ++i) {
    const double next = slope(at.fractions[i]);
    const double begin = at.fractions[i - 1];
    const double length = at.fractions[i] - begin;
    nearest = next > 0.0 ? begin - previous * length / (next - previous) : at.fractions[i];
    previous = next;
  }
  return excess(position(nearest), half_size).norm();
}

}  // namespace ur_simulator
