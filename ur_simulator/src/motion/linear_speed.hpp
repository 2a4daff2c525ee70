#pragma once

#include "motion/cartesian_path.hpp"
#include "motion/motion.hpp"

namespace ur_simulator {

/// speedl and stopl: the TCP's velocity goes straight to its target; its linear and angular part together,
/// neither changing faster than `acceleration` (m/s^2, rad/s^2).
class LinearSpeed final : public Motion {
 public:
  LinearSpeed(const CartesianPath & path, const Setpoint & from, const Vector6 & twist, double acceleration,
              double time);

  std::optional<MotionFault> advance(const Tick & tick, Setpoint & now) override;
  bool released() const override { return released_; }
  bool done() const override { return done_; }
  void brake() override;

 private:
  CartesianPath path_;
  Transform pose_;
  Vector6 twist_;
  Vector6 target_;
  double acceleration_;
  double time_;
  double elapsed_ = 0.0;
  bool released_ = false;
  bool done_ = false;
};

}  // namespace ur_simulator
