#pragma once

#include "common/types.hpp"

namespace ur_simulator {

/// Target joint position (rad) and velocity (rad/s): the state that one motion hands over to the next.
struct Setpoint {
  Vector6 position = Vector6::Zero();
  Vector6 velocity = Vector6::Zero();
};

/// Time that passes in one control cycle.
struct TimeStep {
  double duration;       ///< s of simulated time
  double speed_scaling;  ///< of trajectories, 0 (stopped) to 1, already ramped
};

}  // namespace ur_simulator
