#pragma once

#include <optional>

#include "motion/setpoint.hpp"
#include "state/faults.hpp"

namespace ur_simulator {

/// One way of moving. Built at the setpoint it takes over from; never changes its velocity by leaps.
class Motion {
 public:
  virtual ~Motion() = default;

  /// One cycle further. On a fault `now` is left as it was, and the arm brakes.
  virtual std::optional<MotionFault> advance(const Tick & tick, Setpoint & now) = 0;
  /// May the URScript call that started it return?
  virtual bool released() const = 0;
  /// Stands still at its end: nothing more will come of it.
  virtual bool done() const = 0;
  /// From now on decelerate along the path to standstill, then be done.
  virtual void brake() = 0;
  /// Does it say where the joints are, rather than where their servo loops are to lead them?
  virtual bool leads_actual() const { return false; }
};

}  // namespace ur_simulator
