#include "motion/linear_speed.hpp"

#include <algorithm>

#include "common/pose.hpp"
#include "motion/takeover.hpp"

namespace ur_simulator {

LinearSpeed::LinearSpeed(const CartesianPath & path, const Setpoint & from, const Vector6 & twist,
                         double acceleration, double time)
    : path_(path),
      pose_(path.tcp(from.position)),
      twist_(path.twist(from)),
      target_(twist),
      acceleration_(acceleration),
      time_(time)
{
}

std::optional<MotionFault> LinearSpeed::advance(const Tick & tick, Setpoint & now)
{
  elapsed_ += tick.duration;
  if (time_ > 0.0 && elapsed_ > time_ + 0.5 * tick.duration) {
    brake();
  }
  const Vector6 change = target_ - twist_;
  const double largest = std::max(change.head<3>().norm(), change.tail<3>().norm());
  const double step = acceleration_ * tick.duration;
  const Vector6 next = largest > step ? Vector6(twist_ + change * (step / largest)) : target_;
  const Vector6 moved = 0.5 * tick.duration * (twist_ + next);
  Transform pose = pose_;
  pose.translation() += moved.head<3>();
  // Normalised every cycle, lest rounding adds up to something that is no rotation any more.
  pose.linear() =
      Eigen::Quaterniond(to_rotation(moved.tail<3>()) * pose_.linear()).normalized().toRotationMatrix();
  if (const auto fault = path_.follow(pose, tick.duration, now)) {
    return fault;
  }
  pose_ = pose;
  twist_ = next;
  const bool time_is_up = time_ > 0.0 && elapsed_ > time_ - 0.5 * tick.duration;
  released_ = released_ || time_is_up || (time_ <= 0.0 && largest <= step);
  if (twist_.isZero(0.0) && target_.isZero(0.0)) {
    now.velocity.setZero();
    done_ = true;
  }
  return std::nullopt;
}

void LinearSpeed::brake()
{
  target_.setZero();
  acceleration_ = std::max(acceleration_, takeover_deceleration);
  released_ = true;
}

}  // namespace ur_simulator
