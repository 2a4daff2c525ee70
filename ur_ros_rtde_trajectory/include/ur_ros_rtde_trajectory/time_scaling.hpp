#pragma once

#include "ur_ros_rtde_trajectory/trajectory.hpp"

namespace ur_ros_rtde::trajectory {

/// Time scaling of a plan that is sent to a controller setpoint by setpoint. The time of the plan advances
/// with the controller's clock at a rate from 0 to 1. The rate changes smoothly if another rate is requested
/// or the host was late. After a late setpoint, the plan continues where the last setpoint was, to which the
/// arm has gone on (`lead`), slowed down by as much as the arm has slowed down in the meantime. Where the
/// velocity of the plan changes, the setpoint may step.
///
/// The plan keeps its limits at any constant rate. A change of the rate r adds q' r' to the accelerations and
/// q' r'' to the jerks. It uses the remaining margin of the limits, and as much as the limits themselves, up
/// to 2 /s, if the margin is smaller: together with the plan, it may use twice the limits. A target rate of 0
/// therefore always brakes, and takes as long as braking from a constant speed.
class TimeScaling {
 public:
  /// What the controller does with setpoints.
  struct Servo {
    double cycle;  ///< s, cycle time of the controller
    double lag;    ///< s, in which the arm slows down while its setpoint stands still
    /// Cycles between two setpoints that the controller bridges. The arm slows down in longer gaps.
    double bridged_cycles = 2.0;
    /// s, by which the setpoints are ahead of the plan. In longer gaps the arm moves on towards its setpoint.
    double lead = 0.0;
  };

  /// Starts at `time` of the plan.
  TimeScaling(const Servo & servo, double rate, double time = 0.0) : servo_(servo), time_(time), rate_(rate)
  {
  }

  /// Advances the time of the plan. `elapsed`: time of the controller's clock since the previous setpoint, s.
  /// `target_rate`: requested rate. `point`: the plan at time().
  void advance(double elapsed, double target_rate, const Point & point, const Limits & limits);

  /// Time of the plan in s.
  double time() const { return time_; }
  double rate() const { return rate_; }
  /// Change of the rate, 1/s.
  double rate_dot() const { return rate_dot_; }

 private:
  /// Bounds of the changes of the rate.
  struct Bounds {
    double rate_dot;   // 1/s
    double rate_ddot;  // 1/s^2
  };

  void slow_for_delay(double delay);
  void update_rate(double duration, double target_rate, const Bounds & bounds);

  Servo servo_;
  double time_;
  double rate_;
  double rate_dot_ = 0.0;  // 1/s
};

}  // namespace ur_ros_rtde::trajectory
