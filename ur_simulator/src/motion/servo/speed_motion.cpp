#include "motion/servo/speed_motion.hpp"

#include <algorithm>

#include "motion/path/residual_motion.hpp"

namespace ur_simulator {

SpeedMotion::SpeedMotion(const Vector6 & target, double acceleration, double time)
    : target_(target), acceleration_(acceleration), time_(time)
{
}

void SpeedMotion::begin_cycle(double duration)
{
  elapsed_ += duration;
  if (time_ > 0.0 && elapsed_ > time_ + 0.5 * duration) {
    decelerate();
  }
}

void SpeedMotion::end_cycle(double duration, const Vector6 & velocity, bool velocity_reached)
{
  const bool time_is_up = time_ > 0.0 && elapsed_ > time_ - 0.5 * duration;
  call_complete_ = call_complete_ || time_is_up || (time_ <= 0.0 && velocity_reached);
  finished_ = velocity.isZero(0.0) && target_.isZero(0.0);
}

void SpeedMotion::decelerate()
{
  target_.setZero();
  acceleration_ = std::max(acceleration_, min_takeover_deceleration);
  call_complete_ = true;
}

}  // namespace ur_simulator
