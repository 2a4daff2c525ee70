#include "streaming/servo_setpoint.hpp"

namespace ur_ros_rtde {

trajectory::Joints servo_setpoint(const JointMotion & desired, const ServoParameters & servo,
                                  const trajectory::Limits & limits)
{
  const trajectory::Joints setpoint =
      desired.position + servo.lookahead_time * desired.velocity + desired.acceleration / servo.gain;
  return setpoint.max(limits.position_min.min(desired.position))
      .min(limits.position_max.max(desired.position));
}

}  // namespace ur_ros_rtde
