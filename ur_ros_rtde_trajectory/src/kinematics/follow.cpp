#include "kinematics/follow.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "kinematics/extent.hpp"

namespace ur_ros_rtde::kinematics {
namespace {

using trajectory::SampledBlock;

constexpr double longest_step = 0.005;    // m of the way
constexpr double shortest_step = 2e-6;    // m
constexpr double longest_turn = 0.04;     // rad of a joint, between two samples
constexpr int fewest_intervals = 8;       // of a block
constexpr double least_singular = 0.01;   // of the Jacobian, rotations by arm_length
constexpr double nearly_singular = 0.05;  // rad from where a joint makes the arm singular

double smallest_singular_value(Jacobian jacobian)
{
  jacobian.bottomRows<3>() *= arm_length;
  const Eigen::SelfAdjointEigenSolver<Jacobian> squares(jacobian * jacobian.transpose(),
                                                        Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, squares.eigenvalues()[0]));
}

/// The three ways in which a UR arm loses a direction.
const char * singularity_of(const Joints & q)
{
  if (std::abs(std::sin(q[4])) < nearly_singular) {
    return "wrist_2_joint is near 0 or pi, the axes of wrist_1_joint and wrist_3_joint are parallel";
  }
  if (std::abs(std::sin(q[2])) < nearly_singular) {
    return "elbow_joint is near 0, the arm is stretched out";
  }
  return "the wrist is near the axis of shoulder_pan_joint";
}

}  // namespace

Twist Correction::at(double place) const
{
  const auto after = std::upper_bound(places_.begin(), places_.end(), place);
  const auto i = static_cast<std::size_t>(after - places_.begin());
  if (i == 0 || i == places_.size()) {
    return i == 0 ? values_.front() : values_.back();
  }
  const double part = (place - places_[i - 1]) / (places_[i] - places_[i - 1]);
  return (1.0 - part) * values_[i - 1] + part * values_[i];
}

Expected<std::vector<SampledBlock>> Follower::follow(const Joints & start, const Correction & correction,
                                                     const std::stop_token & stop) const
{
  std::vector<SampledBlock> blocks;
  const std::vector<double> stops = path_.stops();
  Joints q = start;
  for (std::size_t k = 1; k < stops.size(); ++k) {
    if (stop.stop_requested()) {
      return failure(ErrorCode::canceled, "the plan is not wanted any more");
    }
    auto block = follow_block(stops[k - 1], stops[k], q, correction);
    if (!block) {
      return tl::unexpected(block.error());
    }
    q = block->positions.back();
    blocks.push_back(std::move(*block));
  }
  return blocks;
}

Expected<SampledBlock> Follower::follow_block(double from, double to, const Joints & start,
                                              const Correction & correction) const
{
  Sample sample{from, start};
  SampledBlock block{{from}, {start}, {}};
  if (Status fine = examine(sample); !fine) {
    return tl::unexpected(fine.error());
  }
  double step = std::min(longest_step, (to - from) / fewest_intervals);
  while (sample.place < to) {
    const auto following = next(sample, to, correction, step);
    if (!following) {
      return tl::unexpected(following.error());
    }
    block.place.push_back(following->place);
    block.positions.push_back(following->q);
    block.shortest.push_back(shortest_time(sample.place, following->place));
    sample = *following;
  }
  return block;
}

/// `step` shrinks where the joints turn fast, and grows again.
Expected<Follower::Sample> Follower::next(const Sample & last, double to, const Correction & correction,
                                          double & step) const
{
  for (; step > shortest_step; step *= 0.5) {
    const bool at_end = to - last.place < 1.5 * step;
    const double place = at_end ? to : last.place + step;
    const auto q = arm_.inverse(moved(path_.at(place), correction.at(place)), last.q);
    if (q && (*q - last.q).abs().maxCoeff() < longest_turn) {
      const Sample sample{place, *q};
      step = std::min(1.5 * step, longest_step);
      return examine(sample).map([&sample] { return sample; });
    }
  }
  return failure(ErrorCode::unreachable,
                 fmt::format("the arm cannot follow {}: {}", where(last.place), singularity_of(last.q)));
}

Status Follower::examine(const Sample & sample) const
{
  for (int j = 0; j < trajectory::joint_count; ++j) {
    if (sample.q[j] < limits_.position_min[j] || sample.q[j] > limits_.position_max[j]) {
      return failure(ErrorCode::unreachable,
                     fmt::format("{} would be at {:.4f} rad {}, its limits are {:.4f} to {:.4f} rad",
                                 trajectory::joint_name(j), sample.q[j], where(sample.place),
                                 limits_.position_min[j], limits_.position_max[j]));
    }
  }
  if (smallest_singular_value(arm_.jacobian(sample.q)) < least_singular) {
    return failure(ErrorCode::unreachable, fmt::format("the arm is near a singularity {}: {}",
                                                       where(sample.place), singularity_of(sample.q)));
  }
  return {};
}

double Follower::shortest_time(double from, double to) const
{
  const Twist way = difference(path_.at(from), path_.at(to));
  return std::max(way.head<3>().norm() / options_.speed, way.tail<3>().norm() / options_.rotation_speed);
}

std::string Follower::where(double place) const
{
  // The first place is where the arm is; the caller's poses come after it.
  const auto & places = path_.places();
  const auto next = std::lower_bound(places.begin(), places.end(), place - 1e-9) - places.begin();
  const Pose pose = path_.at(place);
  return fmt::format(
      "{} poses[{}], at ({:.3f}, {:.3f}, {:.3f}) m",
      next > 0 && place > places[static_cast<std::size_t>(next)] - 1e-6 ? "at" : "on the way to",
      std::max<std::ptrdiff_t>(next - 1, 0), pose.translation().x(), pose.translation().y(),
      pose.translation().z());
}

}  // namespace ur_ros_rtde::kinematics
