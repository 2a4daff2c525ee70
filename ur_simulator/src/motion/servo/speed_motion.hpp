#pragma once

#include <functional>
#include <optional>

#include "motion/motion.hpp"

namespace ur_simulator {

/// A motion to a target velocity, optionally for a limited time: speedj, speedl and the stops. The speed
/// slider scales its time, and thus its velocity: UR's passthrough trajectory controller, which executes
/// trajectories by speedj, slows down with the slider. What decelerates to standstill is not scaled
/// (assumed).
class SpeedMotion : public Motion {
 public:
  bool call_complete() const final { return call_complete_; }
  bool finished() const final { return finished_; }
  bool is_unattended() const final { return call_complete_ && target_.isZero(0.0); }
  /// Decelerates to standstill, at min_takeover_deceleration at least.
  void decelerate() final;

 protected:
  /// `acceleration` in m/s^2 or rad/s^2. After `time` s the arm decelerates; 0: no time limit.
  SpeedMotion(const Vector6 & target, double acceleration, double time);

  /// Starts a cycle; decelerates when the time is up.
  void begin_cycle(const TimeStep & time_step);
  /// The velocity after this cycle: it goes straight to the target. `size` of a change is at most
  /// acceleration times time; both are scaled, except for an arm that is too fast.
  Vector6 next_velocity(const Vector6 & velocity, const std::function<double(const Vector6 &)> & size);
  /// Ends a cycle with this velocity.
  void end_cycle(const Vector6 & velocity);
  const Vector6 & target() const { return target_; }

 private:
  Vector6 target_;
  double acceleration_;
  double time_;
  double elapsed_ = 0.0;                ///< s, scaled
  double duration_ = 0.0;               ///< s of this cycle
  double scaling_ = 1.0;                ///< of its time and velocity
  std::optional<double> last_scaling_;  ///< of the cycle before
  bool velocity_reached_ = false;
  bool call_complete_ = false;
  bool finished_ = false;
};

}  // namespace ur_simulator
