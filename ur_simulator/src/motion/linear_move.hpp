#pragma once

#include "motion/arm.hpp"
#include "motion/cartesian_path.hpp"
#include "motion/motion.hpp"
#include "motion/profile.hpp"
#include "motion/takeover.hpp"

namespace ur_simulator {

/// movel: the TCP on a straight line, its rotation about one axis, both on one trapezoid. Speed and
/// acceleration are those of the TCP's way, or of its turning times `turning_radius` where that is longer.
class LinearMove final : public Motion {
 public:
  LinearMove(const CartesianPath & path, const Setpoint & from, const Vector6 & target,
             const MoveOptions & options);

  std::optional<MotionFault> advance(const Tick & tick, Setpoint & now) override;
  bool released() const override { return done(); }
  bool done() const override { return done_; }
  void brake() override;

  static constexpr double turning_radius = 0.3;  ///< m

 private:
  Transform pose_at(double distance) const;

  CartesianPath path_;
  Transform start_;
  Runout runout_;
  Vector3 way_ = Vector3::Zero();   ///< m per unit of the profile's distance
  Vector3 turn_ = Vector3::Zero();  ///< rotation vector, in the frame where the runout leaves the TCP
  double length_ = 1.0;
  TrapezoidProfile profile_;
  PathClock clock_;
  bool done_ = false;
};

}  // namespace ur_simulator
