#pragma once

#include "ur_ros_rtde_trajectory/trajectory.hpp"

namespace ur_ros_rtde::trajectory {

/// The time axis of a plan that is sent to a controller target by target. It runs with the controller's
/// clock, at a rate from 0 to 1 times as fast, and changes the rate smoothly: when the speed is to be another
/// one, and when the host was late. A target that came late is not skipped; the plan goes on from there,
/// first as much slower as the arm has become by waiting for it.
///
/// Any constant rate keeps the limits that the plan keeps. A change of the rate r adds q' r' to the
/// accelerations and q' r'' to the jerks: it takes what room the limits leave, and 2 /s where they leave
/// less.
class TimeScaling {
 public:
  /// `cycle`: of the controller, s. `memory`: how long the controller takes to follow a target, s. Begins at
  /// `time` of the plan.
  TimeScaling(double cycle, double servo_lag, double rate, double time = 0.0)
      : cycle_(cycle), servo_lag_(servo_lag), time_(time), rate_(rate)
  {
  }

  /// `elapsed` seconds of the controller's clock have passed since the last target. `wanted`: the rate to go
  /// to. `point`: the plan at time().
  void advance(double elapsed, double target_rate, const Point & point, const Limits & limits);

  /// s, of the plan
  double time() const { return time_; }
  double rate() const { return rate_; }

 private:
  void slow_for_delay(double delay);
  void update_rate(double duration, double target_rate, double max_rate_dot, double max_rate_ddot);

  double cycle_, servo_lag_;
  double time_;
  double rate_;
  double rate_dot_ = 0.0;  // of the rate, 1/s
};

}  // namespace ur_ros_rtde::trajectory
