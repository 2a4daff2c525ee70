#pragma once

#include <ur_rtde/rtde_control_interface.h>

#include "ur_ros_rtde_robot/state/sample.hpp"

namespace ur_ros_rtde {

/// The times of the setpoints of a servo motion (servoJ with a time). The control program moves its target
/// along the setpoints at the pace of their times, never faster. If they come in a bunch, for example from a
/// busy host, the target stays behind; the clock then advances more slowly until the target has caught up.
///
/// The times begin anew with each motion: the controller keeps registers with 32 bits (a value that was
/// written came back as its float, Universal Robots' forum, topic 7623). Cycles since its start would lose
/// their fractions, and after nine hours whole cycles.
class SetpointClock {
 public:
  /// A setpoint advances the time by at most this; the control program does not bridge longer gaps.
  static constexpr double bridged_cycles = ur_rtde::RTDEControlInterface::SERVO_EXTRAPOLATION_CYCLES + 1;

  /// From here on, the times begin anew: the control program begins at a setpoint that is earlier than the
  /// last.
  static constexpr double longest_time = 1e6;

  /// `cycle` of the controller, s.
  explicit SetpointClock(double cycle) : cycle_(cycle) {}

  /// Advances to a setpoint that is due `elapsed` s (controller time) after the previous one. Returns the
  /// part of `elapsed` by which the motion may go on, s.
  double advance(const Sample & now, double elapsed);
  /// Of the setpoint that is due now, in cycles of the controller.
  double time() const { return time_; }
  /// Whether the target has followed a plan that ended `overtime` s ago (negative: goes on).
  bool is_at_end(double overtime) const;

 private:
  static constexpr double first_time = 1.0;  // 0: a setpoint without a time

  double cycle_;
  double time_ = first_time;
  double pace_ = 1.0;  ///< share of the elapsed time
};

}  // namespace ur_ros_rtde
