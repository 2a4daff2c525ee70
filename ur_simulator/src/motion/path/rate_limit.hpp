#pragma once

#include <array>
#include <cstddef>

#include "motion/path/speed_profile.hpp"
#include "motion/path/tcp_segment.hpp"
#include "motion/tcp_kinematics.hpp"

namespace ur_simulator {

/// The highest rate of the clock of a Cartesian path at which all joints keep their speed limits, as a
/// function of the time of the path. The rate changes by at most 3 per second, so that the motion slows down
/// before it reaches a fast section. Sections that would need a rate below 0.2 are not slowed down further:
/// there the path leads through a singularity. The rate of a path faster than 1 m/s may be lower.
class RateLimit {
 public:
  /// No limit.
  RateLimit() = default;
  /// `near_start` is a joint position near the start of the path, which selects the configuration of the arm.
  RateLimit(const RobotModel & model, const TcpKinematics & kinematics, const TcpSegment & path,
            const SpeedProfile & profile, const Vector6 & near_start);

  double at(double time) const;

 private:
  static constexpr std::size_t intervals = 64;

  /// Lowers the limits of neighbors so that the rate can change from one to the other.
  void bound_rate_of_change();

  bool limits_ = false;
  double interval_ = 0.0;                      ///< s of the path
  std::array<double, intervals + 1> rates_{};  ///< at the ends of the intervals
};

}  // namespace ur_simulator
