#pragma once

#include <optional>

#include "motion/setpoint.hpp"
#include "state/faults.hpp"

namespace ur_simulator {

/// One motion of the arm. It starts from the current setpoint; its velocity is continuous.
class Motion {
 public:
  virtual ~Motion() = default;

  /// Advances by one control cycle. On a fault `setpoint` is unchanged and the arm decelerates.
  virtual std::optional<MotionFault> advance(const TimeStep & time_step, Setpoint & setpoint) = 0;
  /// True when the URScript call that started the motion may return.
  virtual bool call_complete() const = 0;
  /// True when the motion is over and its setpoint stands still.
  virtual bool finished() const = 0;
  /// Decelerates along the path to standstill; the motion is then finished.
  virtual void decelerate() = 0;
  /// True when its call has returned and it goes on, to be followed by another motion.
  virtual bool is_unattended() const { return false; }
  /// True if the setpoint is the actual joint position, as under torque control, and not the target of the
  /// servo loops.
  virtual bool controls_actual_joints() const { return false; }
};

}  // namespace ur_simulator
