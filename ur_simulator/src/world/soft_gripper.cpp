#include "world/soft_gripper.hpp"

#include <algorithm>

namespace ur_simulator {

void SoftGripper::move_to(double width, bool gentle)
{
  target_ = std::clamp(width, min_width, max_width);
  gentle_ = gentle;
}

void SoftGripper::step(double duration)
{
  if (stuck_) {
    return;
  }
  const double step = (gentle_ ? gentle_speed : speed) * duration;
  const double next = width_ + std::clamp(target_ - width_, -step, step);
  const bool blocked = object_ > 0.0 && width_ >= object_ && next < object_;
  width_ = blocked ? object_ : next;
  if (blocked) {
    target_ = object_;  // holds the object
  }
}

}  // namespace ur_simulator
