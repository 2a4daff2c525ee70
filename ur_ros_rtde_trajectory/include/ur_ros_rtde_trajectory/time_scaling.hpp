#pragma once

#include "ur_ros_rtde_trajectory/trajectory.hpp"

namespace ur_ros_rtde::trajectory {

/// Time scaling of a plan that is sent to a controller setpoint by setpoint. The time of the plan advances
/// with the controller's clock at a rate from 0 to 1. The rate changes smoothly if another rate is requested
/// or the host was late. After a late setpoint, no part of the plan is skipped: the plan continues where it
/// was, first slowed down by as much as the arm has slowed down meanwhile.
///
/// The plan keeps its limits at any constant rate. A change of the rate r adds q' r' to the accelerations and
/// q' r'' to the jerks. It uses the remaining margin of the limits, and 2 /s if the margin is smaller.
class TimeScaling {
 public:
  /// Starts at `time` of the plan. `cycle`: cycle time of the controller, s. `servo_lag`: time that the
  /// controller takes to follow a setpoint, s.
  TimeScaling(double cycle, double servo_lag, double rate, double time = 0.0)
      : cycle_(cycle), servo_lag_(servo_lag), time_(time), rate_(rate)
  {
  }

  /// Advances the time of the plan. `elapsed`: time of the controller's clock since the previous setpoint, s.
  /// `target_rate`: requested rate. `point`: the plan at time().
  void advance(double elapsed, double target_rate, const Point & point, const Limits & limits);

  /// Time of the plan in s.
  double time() const { return time_; }
  double rate() const { return rate_; }

 private:
  void slow_for_delay(double delay);
  void update_rate(double duration, double target_rate, double max_rate_dot, double max_rate_ddot);

  double cycle_, servo_lag_;
  double time_;
  double rate_;
  double rate_dot_ = 0.0;  // 1/s
};

}  // namespace ur_ros_rtde::trajectory
