#pragma once

#include "motion/motion.hpp"

namespace ur_simulator {

/// A motion to a target velocity, optionally for a limited time: speedj, speedl and the stops.
class SpeedMotion : public Motion {
 public:
  bool call_complete() const final { return call_complete_; }
  bool finished() const final { return finished_; }
  /// Decelerates to standstill, at min_takeover_deceleration at least.
  void decelerate() final;

 protected:
  /// `acceleration` in m/s^2 or rad/s^2. After `time` s the arm decelerates; 0: no time limit.
  SpeedMotion(const Vector6 & target, double acceleration, double time);

  /// Starts a cycle; decelerates when the time is up.
  void begin_cycle(double duration);
  /// Ends a cycle; `velocity_reached`: the velocity equals the target.
  void end_cycle(double duration, const Vector6 & velocity, bool velocity_reached);
  const Vector6 & target() const { return target_; }
  double acceleration() const { return acceleration_; }

 private:
  Vector6 target_;
  double acceleration_;
  double time_;
  double elapsed_ = 0.0;
  bool call_complete_ = false;
  bool finished_ = false;
};

}  // namespace ur_simulator
