#pragma once

#include <algorithm>

namespace ur_simulator {

/// Limits how often something happens: `burst` times at once, then `rate` times per second.
class RateLimit {
 public:
  RateLimit(double burst, double rate) : burst_(burst), rate_(rate), available_(burst) {}

  /// Returns whether it may happen once more. `now`: s; a clock that was set back does not matter.
  bool take(double now)
  {
    available_ = std::min(burst_, available_ + rate_ * std::max(0.0, now - last_));
    last_ = now;
    if (available_ < 1.0) {
      return false;
    }
    available_ -= 1.0;
    return true;
  }

 private:
  double burst_;
  double rate_;
  double available_;
  double last_ = 0.0;
};

}  // namespace ur_simulator
