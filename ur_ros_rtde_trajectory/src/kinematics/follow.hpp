#pragma once

#include <vector>

#include "kinematics/tcp_path.hpp"
#include "ur_ros_rtde_trajectory/cartesian.hpp"
#include "ur_ros_rtde_trajectory/sampled.hpp"

namespace ur_ros_rtde::kinematics {

/// By which the published arm is beside the real one, along the way: linear between places.
class Correction {
 public:
  void add(double place, const Twist & value)
  {
    places_.push_back(place);
    values_.push_back(value);
  }
  /// At least one has been added.
  Twist at(double place) const;

 private:
  std::vector<double> places_;  // increasing
  std::vector<Twist> values_;
};

/// Joint positions along a way of the TCP, closely enough for a spline through them. Refused as
/// plan_cartesian says.
class Follower {
 public:
  Follower(const TcpPath & path, const Arm & arm, const trajectory::Limits & limits,
           const CartesianOptions & options)
      : path_(path), arm_(arm), limits_(limits), options_(options)
  {
  }

  Expected<std::vector<trajectory::SampledBlock>> follow(const Joints & start, const Correction & correction,
                                                         const std::stop_token & stop) const;

 private:
  struct Sample {
    double place;
    Joints q;
  };

  Expected<trajectory::SampledBlock> follow_block(double from, double to, const Joints & start,
                                                  const Correction & correction) const;
  Expected<Sample> next(const Sample & last, double to, const Correction & correction, double & step) const;
  Status examine(const Sample & sample) const;
  double shortest_time(double from, double to) const;
  std::string where(double place) const;

  const TcpPath & path_;
  const Arm & arm_;
  const trajectory::Limits & limits_;
  const CartesianOptions & options_;
};

}  // namespace ur_ros_rtde::kinematics
