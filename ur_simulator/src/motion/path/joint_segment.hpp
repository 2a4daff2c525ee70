#pragma once

#include "common/types.hpp"

namespace ur_simulator {

/// A straight line in joint space. Distance along it is the angle of the leading joint (the joint that turns
/// the most), rad.
class JointSegment {
 public:
  JointSegment() = default;
  JointSegment(const Vector6 & start, const Vector6 & target);

  Vector6 at(double distance) const { return start_ + distance * direction_; }
  const Vector6 & start() const { return start_; }
  const Vector6 & target() const { return target_; }
  /// rad of each joint per rad of the leading joint.
  const Vector6 & direction() const { return direction_; }
  double length() const { return length_; }

 private:
  Vector6 start_ = Vector6::Zero();
  Vector6 target_ = Vector6::Zero();
  Vector6 direction_ = Vector6::Zero();
  double length_ = 0.0;
};

}  // namespace ur_simulator
