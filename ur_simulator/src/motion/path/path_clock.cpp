#include "motion/path/path_clock.hpp"

#include <algorithm>

namespace ur_simulator {

void PathClock::decelerate(double speed, double deceleration)
{
  if (rate_deceleration_ > 0.0) {
    return;
  }
  // A path that has hardly begun to move stops at once; the lower bound avoids a division by zero.
  rate_deceleration_ = deceleration / std::max(speed, 1e-9);
}

void PathClock::advance(double duration, double speed_scaling)
{
  const double previous_rate = rate_;
  rate_ = std::max(0.0, rate_ - rate_deceleration_ * duration);
  time_ += 0.5 * (previous_rate + rate_) * duration * speed_scaling;
}

}  // namespace ur_simulator
