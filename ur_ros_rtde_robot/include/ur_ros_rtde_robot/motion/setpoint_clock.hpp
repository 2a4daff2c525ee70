#pragma once

#include <ur_rtde/rtde_control_interface.h>

#include "ur_ros_rtde_robot/state/sample.hpp"

namespace ur_ros_rtde {

/// The times of the setpoints of a servo motion (servoJ with a time). The control program moves its target
/// along the setpoints at the pace of their times, never faster. If they come in a bunch, for example from a
/// busy host, the target stays behind; the clock then advances more slowly until the target has caught up.
class SetpointClock {
 public:
  /// A setpoint advances the time by at most this; the control program does not bridge longer gaps.
  static constexpr double bridged_cycles = ur_rtde::RTDEControlInterface::SERVO_EXTRAPOLATION_CYCLES + 1;

  /// `cycle` of the controller, s.
  SetpointClock(const Sample & now, double cycle) : cycle_(cycle), time_(now.controller_time / cycle) {}

  /// Advances to a setpoint that is due `elapsed` s (controller time) after the previous one. Returns the
  /// part of `elapsed` by which the motion may go on, s.
  double advance(const Sample & now, double elapsed);
  /// Of the setpoint that is due now, in cycles of the controller.
  double time() const { return time_; }
  /// Whether the target has followed a plan that ended `overtime` s ago (negative: goes on).
  bool is_at_end(double overtime) const;

 private:
  double cycle_;
  double time_;
  double pace_ = 1.0;  ///< share of the elapsed time
};

}  // namespace ur_ros_rtde
