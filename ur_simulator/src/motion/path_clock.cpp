#include "motion/path_clock.hpp"

#include <algorithm>

namespace ur_simulator {

void PathClock::brake(double speed, double deceleration)
{
  if (slowing_ > 0.0) {
    return;
  }
  // A path that has hardly begun to move stops at once; the bound keeps the division sane.
  slowing_ = deceleration / std::max(speed, 1e-9);
}

void PathClock::advance(double duration, double speed_scaling)
{
  const double before = rate_;
  rate_ = std::max(0.0, rate_ - slowing_ * duration);
  time_ += 0.5 * (before + rate_) * duration * speed_scaling;
}

}  // namespace ur_simulator
