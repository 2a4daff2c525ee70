#pragma once

#include <vector>

#include "kinematics/tcp_path.hpp"
#include "ur_ros_rtde_trajectory/cartesian.hpp"
#include "ur_ros_rtde_trajectory/sampled.hpp"

namespace ur_ros_rtde::kinematics {

/// Deviation of the nominal kinematics from the real arm along the path, interpolated linearly.
class KinematicCorrection {
 public:
  void add(double u, const Twist & value)
  {
    u_.push_back(u);
    values_.push_back(value);
  }
  /// Requires at least one added value.
  Twist at(double u) const;

 private:
  std::vector<double> u_;  // increasing
  std::vector<Twist> values_;
};

/// Samples joint positions along a TCP path by inverse kinematics, closely enough for a spline through them.
/// Returns errors as described at plan_cartesian.
class CartesianSampler {
 public:
  CartesianSampler(const TcpPath & path, const Arm & arm, const trajectory::Limits & limits,
                   const CartesianOptions & options)
      : path_(path), arm_(arm), limits_(limits), options_(options)
  {
  }

  Expected<std::vector<trajectory::SampledSegment>> sample_path(const Joints & start,
                                                                const KinematicCorrection & correction,
                                                                const std::stop_token & stop) const;

 private:
  struct Sample {
    double u;
    Joints q;
  };

  Expected<trajectory::SampledSegment> sample_segment(double from, double to, const Joints & start,
                                                      const KinematicCorrection & correction,
                                                      std::size_t max_samples_left,
                                                      const std::stop_token & stop) const;
  Expected<Sample> next_sample(const Sample & last, double to, const KinematicCorrection & correction,
                               double & step) const;
  Status check_sample(const Sample & sample) const;
  double min_duration(double from, double to) const;
  std::string describe_position(double u) const;

  const TcpPath & path_;
  const Arm & arm_;
  const trajectory::Limits & limits_;
  const CartesianOptions & options_;
};

}  // namespace ur_ros_rtde::kinematics
