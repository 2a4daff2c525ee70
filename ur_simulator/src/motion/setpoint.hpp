#pragma once

#include "common/types.hpp"

namespace ur_simulator {

/// Where the target joints are and how they move: what one motion leaves to the next.
struct Setpoint {
  Vector6 position = Vector6::Zero();
  Vector6 velocity = Vector6::Zero();
};

/// How time passes for one cycle.
struct Tick {
  double duration;       ///< s of simulated time
  double speed_scaling;  ///< of trajectories: 0 (standing) … 1, already ramped
};

}  // namespace ur_simulator
