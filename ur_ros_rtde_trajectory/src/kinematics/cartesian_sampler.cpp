#include "kinematics/cartesian_sampler.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "kinematics/displacement_norm.hpp"

namespace ur_ros_rtde::kinematics {
namespace {

using trajectory::SampledSegment;

constexpr double max_step = 0.005;            // m along the path
constexpr double min_step = 2e-6;             // m
constexpr std::size_t max_samples = 200'000;  // of a path
constexpr double max_joint_step = 0.04;       // rad; largest change of a joint between two samples
constexpr int min_intervals = 8;              // per segment
constexpr double min_singular_value = 0.01;   // of the Jacobian, rotations scaled by characteristic_length
constexpr double singular_angle = 0.05;       // rad; distance of a joint from a singularity

double smallest_singular_value(Jacobian jacobian)
{
  jacobian.bottomRows<3>() *= characteristic_length;
  const Eigen::SelfAdjointEigenSolver<Jacobian> squares(jacobian * jacobian.transpose(),
                                                        Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, squares.eigenvalues()[0]));
}

/// Names the singularity near q: wrist, elbow or shoulder.
const char * describe_singularity(const Joints & q)
{
  if (std::abs(std::sin(q[4])) < singular_angle) {
    return "wrist_2_joint is near 0 or pi, the axes of wrist_1_joint and wrist_3_joint are parallel";
  }
  if (std::abs(std::sin(q[2])) < singular_angle) {
    return "elbow_joint is near 0, the arm is stretched out";
  }
  return "the wrist is near the axis of shoulder_pan_joint";
}

}  // namespace

Twist KinematicCorrection::at(double u) const
{
  const auto after = std::upper_bound(u_.begin(), u_.end(), u);
  const auto i = static_cast<std::size_t>(after - u_.begin());
  if (i == 0 || i == u_.size()) {
    return i == 0 ? values_.front() : values_.back();
  }
  const double fraction = (u - u_[i - 1]) / (u_[i] - u_[i - 1]);
  return (1.0 - fraction) * values_[i - 1] + fraction * values_[i];
}

Expected<std::vector<SampledSegment>> CartesianSampler::sample_path(const Joints & start,
                                                                    const KinematicCorrection & correction,
                                                                    const std::stop_token & stop) const
{
  std::vector<SampledSegment> segments;
  const std::vector<double> stops = path_.stops();
  Joints q = start;
  std::size_t left = max_samples;
  for (std::size_t k = 1; k < stops.size(); ++k) {
    auto segment = sample_segment(stops[k - 1], stops[k], q, correction, left, stop);
    if (!segment) {
      return tl::unexpected(segment.error());
    }
    left -= segment->positions.size();
    q = segment->positions.back();
    segments.push_back(std::move(*segment));
  }
  return segments;
}

Expected<SampledSegment> CartesianSampler::sample_segment(double from, double to, const Joints & start,
                                                          const KinematicCorrection & correction,
                                                          std::size_t max_samples_left,
                                                          const std::stop_token & stop) const
{
  Sample sample{from, start};
  SampledSegment segment{{from}, {start}, {}};
  if (Status valid = check_sample(sample); !valid) {
    return tl::unexpected(valid.error());
  }
  double step = std::max(std::min(max_step, (to - from) / min_intervals), 2.0 * min_step);
  while (sample.u < to) {
    if (stop.stop_requested()) {
      return failure(ErrorCode::canceled, "planning was canceled");
    }
    if (segment.positions.size() >= max_samples_left) {
      return failure(
          ErrorCode::invalid_goal,
          fmt::format("the path is too long to be planned at once, more than {} samples {}: send it "
                      "in parts",
                      max_samples, describe_position(sample.u)));
    }
    const auto found = next_sample(sample, to, correction, step);
    if (!found) {
      return tl::unexpected(found.error());
    }
    segment.parameters.push_back(found->u);
    segment.positions.push_back(found->q);
    segment.min_durations.push_back(min_duration(sample.u, found->u));
    sample = *found;
  }
  return segment;
}

/// `step` decreases where the joints move fast, and increases again afterwards.
Expected<CartesianSampler::Sample> CartesianSampler::next_sample(const Sample & last, double to,
                                                                 const KinematicCorrection & correction,
                                                                 double & step) const
{
  for (; step > min_step; step *= 0.5) {
    const bool at_end = to - last.u < 1.5 * step;
    const double u = at_end ? to : last.u + step;
    const auto q = arm_.inverse(moved(path_.at(u), correction.at(u)), last.q);
    if (q && (*q - last.q).abs().maxCoeff() < max_joint_step) {
      const Sample sample{u, *q};
      step = std::min(1.5 * step, max_step);
      return check_sample(sample).map([&sample] { return sample; });
    }
  }
  return failure(
      ErrorCode::unreachable,
      fmt::format("the arm cannot follow {}: {}", describe_position(last.u), describe_singularity(last.q)));
}

Status CartesianSampler::check_sample(const Sample & sample) const
{
  for (int j = 0; j < trajectory::joint_count; ++j) {
    if (sample.q[j] < limits_.position_min[j] || sample.q[j] > limits_.position_max[j]) {
      return failure(ErrorCode::unreachable,
                     fmt::format("{} would be at {:.4f} rad {}, its limits are {:.4f} to {:.4f} rad",
                                 trajectory::joint_name(j), sample.q[j], describe_position(sample.u),
                                 limits_.position_min[j], limits_.position_max[j]));
    }
  }
  if (smallest_singular_value(arm_.jacobian(sample.q)) < min_singular_value) {
    return failure(ErrorCode::unreachable,
                   fmt::format("the arm is near a singularity {}: {}", describe_position(sample.u),
                               describe_singularity(sample.q)));
  }
  return {};
}

double CartesianSampler::min_duration(double from, double to) const
{
  const Twist displacement = difference(path_.at(from), path_.at(to));
  return std::max(displacement.head<3>().norm() / options_.speed,
                  displacement.tail<3>().norm() / options_.rotation_speed);
}

std::string CartesianSampler::describe_position(double u) const
{
  // The first pose is the start of the arm; the poses of the caller follow.
  const auto & waypoints = path_.waypoints();
  const auto next = std::lower_bound(waypoints.begin(), waypoints.end(), u - 1e-9) - waypoints.begin();
  const Pose pose = path_.at(u);
  return fmt::format(
      "{} poses[{}], at ({:.3f}, {:.3f}, {:.3f}) m",
      next > 0 && u > waypoints[static_cast<std::size_t>(next)] - 1e-6 ? "at" : "on the way to",
      std::max<std::ptrdiff_t>(next - 1, 0), pose.translation().x(), pose.translation().y(),
      pose.translation().z());
}

}  // namespace ur_ros_rtde::kinematics
