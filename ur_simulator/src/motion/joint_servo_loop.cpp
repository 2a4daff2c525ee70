#include "motion/joint_servo_loop.hpp"

namespace ur_simulator {

JointServoLoop::JointServoLoop(Series series, double cycle_time, const Vector6 & position)
    : cycle_time_(cycle_time), gain_(cycle_time / (cycle_time + lag(series))), position_(position)
{
}

void JointServoLoop::advance(const Vector6 & target)
{
  const Vector6 error = target - position_;
  // Skip the last nanoradian, so that the velocity at standstill is 0.
  const Vector6 step = error.cwiseAbs().maxCoeff() < 1e-9 ? error : Vector6(gain_ * error);
  position_ += step;
  velocity_ = step.cwiseAbs().maxCoeff() < 1e-9 ? Vector6(Vector6::Zero()) : Vector6(step / cycle_time_);
}

void JointServoLoop::set_state(const Vector6 & position, const Vector6 & velocity)
{
  position_ = position;
  velocity_ = velocity;
}

void JointServoLoop::jump_to(const Vector6 & position)
{
  position_ = position;
  velocity_.setZero();
}

}  // namespace ur_simulator
