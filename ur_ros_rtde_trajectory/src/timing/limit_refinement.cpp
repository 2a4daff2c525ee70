#include "timing/limit_refinement.hpp"

#include <algorithm>
#include <cmath>

#include "motion/verify.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

constexpr int inner_points = 3;           // verified points between two stations
constexpr double nearly_binding = 0.8;    // utilization of a limit
constexpr double lowest_fraction = 0.3;   // of a limit
constexpr double shortest_parent = 2e-4;  // s; shorter intervals are not subdivided

// Into how many parts of the same duration an interval is divided: `wanted`, or 1 if a part would be empty.
// The solver divides by the lengths.
int number_of_parts(const TimingLawPiece & piece, double from, double to, int wanted)
{
  constexpr double shortest = 1e-3;  // of the interval
  double previous = from;
  for (int k = 1; k <= wanted; ++k) {
    const double end = k == wanted ? to : piece.at(piece.start + piece.duration * k / wanted).u;
    if (!(end - previous > shortest * (to - from))) {
      return 1;
    }
    previous = end;
  }
  return wanted;
}

}  // namespace

double IntervalUtilization::slowdown() const
{
  return std::max({velocity, std::sqrt(acceleration), std::cbrt(jerk)});
}

std::vector<IntervalUtilization> interval_utilization(const Motion & motion, std::size_t begin,
                                                      const Limits & limits)
{
  std::vector<IntervalUtilization> result;
  result.reserve(motion.timing.size() - begin);
  for (std::size_t k = begin; k < motion.timing.size(); ++k) {
    const PieceUtilization use = piece_utilization(motion, motion.timing[k], limits, inner_points);
    unsigned joints = 0;
    for (unsigned j = 0; j < joint_count; ++j) {
      joints |= std::max(use.acceleration[j], use.jerk[j]) > nearly_binding ? 1U << j : 0U;
    }
    IntervalUtilization largest{std::max(use.speed, use.velocity.maxCoeff()), use.acceleration.maxCoeff(),
                                use.jerk.maxCoeff(), static_cast<std::uint8_t>(joints)};
    const bool at_rest = k == begin || k + 1 == motion.timing.size();
    largest.too_long = !at_rest && motion.timing[k].duration > shortest_parent &&
                       (std::max(largest.acceleration, largest.jerk) > 1.03 || largest.velocity > 1.002);
    result.push_back(largest);
  }
  return result;
}

void tighten_limits(const std::vector<IntervalUtilization> & use, LimitFractions & fractions)
{
  constexpr double margin = 0.998;
  const LimitFractions previous = fractions;
  const auto tighten = [](double & fraction, double value) {
    fraction = std::max(lowest_fraction, std::min(fraction, value));
  };
  for (std::size_t i = 0; i < use.size(); ++i) {
    fractions.binding_joints[i] |= use[i].binding_joints;
    if (use[i].too_long) {
      continue;
    }
    if (use[i].jerk > 1.002) {
      tighten(fractions.jerk[i], previous.jerk[i] * margin / use[i].jerk);
    }
    for (const std::size_t m : {i, i + 1}) {
      if (use[i].acceleration > 1.001) {
        tighten(fractions.acceleration[m], previous.acceleration[m] * margin / use[i].acceleration);
      }
      if (use[i].velocity > 1.0004) {
        tighten(fractions.velocity[m], previous.velocity[m] / use[i].velocity);
      }
    }
  }
}

ResampledMotion subdivide(const Motion & motion, std::size_t begin, const Grid & grid,
                          const std::vector<IntervalUtilization> & use, LimitFractions & fractions)
{
  ResampledMotion result;
  result.grid.reserve(grid.intervals() * 5 / 4);
  result.profile.v.push_back(0.0);
  result.profile.alpha.push_back(0.0);
  LimitFractions refined;
  refined.velocity.push_back(1.0);
  refined.acceleration.push_back(1.0);
  for (std::size_t i = 0; i < grid.intervals(); ++i) {
    const TimingLawPiece & piece = motion.timing[begin + i];
    const int wanted = !use[i].too_long ? 1 : std::max(use[i].acceleration, use[i].jerk) < 1.3 ? 2 : 3;
    const int parts = number_of_parts(piece, grid.begin[i], grid.end[i], wanted);
    double from = grid.begin[i];
    for (int k = 1; k <= parts; ++k) {
      const bool last = k == parts;
      const PathState state = piece.at(piece.start + piece.duration * k / parts);
      const double to = last ? grid.end[i] : state.u;
      result.grid.add(*motion.path, grid.piece[i], from, to);
      result.profile.v.push_back(state.v);
      result.profile.alpha.push_back(state.a);
      result.profile.time.push_back(piece.duration / parts);
      refined.velocity.push_back(last ? fractions.velocity[i + 1] : 1.0);
      refined.acceleration.push_back(last ? fractions.acceleration[i + 1] : 1.0);
      refined.jerk.push_back(parts > 1 ? 1.0 : fractions.jerk[i]);
      refined.binding_joints.push_back(fractions.binding_joints[i]);
      from = to;
    }
  }
  result.profile.v.back() = result.profile.alpha.back() = 0.0;
  fractions = std::move(refined);
  return result;
}

}  // namespace ur_ros_rtde::trajectory
