#include "ur_ros_rtde_trajectory/cartesian.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kinematics/extent.hpp"
#include "kinematics/follow.hpp"

namespace ur_ros_rtde::kinematics {
namespace {

using trajectory::SampledBlock;
using trajectory::Trajectory;

constexpr std::size_t most_references = 100;
constexpr double same_correction = 1e-5;  // m
constexpr double farthest = 0.015;        // m: beyond that it is not the same arm

/// The joint positions at a place, of blocks that were followed without knowing better.
Joints joints_at(const std::vector<SampledBlock> & blocks, double place)
{
  for (const SampledBlock & block : blocks) {
    const auto after = std::lower_bound(block.place.begin(), block.place.end(), place);
    if (after != block.place.end()) {
      return block.positions[static_cast<std::size_t>(after - block.place.begin())];
    }
  }
  return blocks.back().positions.back();
}

/// What the reference says at the poses, beside what the arm as published makes of it.
Expected<Correction> ask(const TcpPath & path, const Arm & arm, const std::vector<SampledBlock> & blocks,
                         const Twist & first, const Reference & reference, const std::stop_token & stop)
{
  Correction correction;
  correction.add(0.0, first);
  const auto & places = path.places();
  const std::size_t stride = std::max<std::size_t>(1, places.size() / most_references);
  double last = 0.0;
  for (std::size_t i = (places.size() - 1) % stride; i < places.size(); i += stride) {
    if (stop.stop_requested()) {
      return failure(ErrorCode::canceled, "the plan is not wanted any more");
    }
    if (places[i] <= last) {
      continue;
    }
    last = places[i];
    const Pose pose = path.at(places[i]);
    const Joints guess = joints_at(blocks, places[i]);
    const auto q = reference(pose, guess);
    if (!q) {
      return tl::unexpected(q.error());
    }
    const Twist off = difference(pose, arm.forward(*q));
    if (extent(off) > farthest) {
      return failure(ErrorCode::not_supported,
                     fmt::format("the controller's joint positions for poses[{}] put the arm, as published, "
                                 "{:.1f} mm beside it: plan in joint space instead",
                                 i - 1, 1e3 * extent(off)));
    }
    correction.add(places[i], off);
  }
  return correction;
}

}  // namespace

Expected<Trajectory> plan_cartesian(const std::vector<Pose> & poses, const Arm & arm, const Joints & start,
                                    const trajectory::Limits & limits, const CartesianOptions & options,
                                    const Reference & reference, const std::stop_token & stop)
{
  const TcpPath path(poses, options.blend_radius);
  const Follower follower(path, arm, limits, options);
  const Twist first = difference(poses.front(), arm.forward(start));
  Correction correction;
  correction.add(0.0, first);
  auto blocks = follower.follow(start, correction, stop);
  if (!blocks) {
    return tl::unexpected(blocks.error());
  }
  const auto better = ask(path, arm, *blocks, first, reference, stop);
  if (!better) {
    return tl::unexpected(better.error());
  }
  const auto & places = path.places();
  const bool differs = std::any_of(places.begin(), places.end(), [&](double place) {
    return extent(better->at(place) - first) > same_correction;
  });
  if (differs) {
    blocks = follower.follow(start, *better, stop);
  }
  if (!blocks) {
    return tl::unexpected(blocks.error());
  }
  return trajectory::plan_sampled(*blocks, places, limits, stop);
}

}  // namespace ur_ros_rtde::kinematics
