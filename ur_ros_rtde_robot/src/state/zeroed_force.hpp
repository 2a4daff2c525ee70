#pragma once

#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {

/// A controller with a force sensor zeroes it at the start of each program (Universal_Robots_ROS_Driver,
/// issues 512 and 643). Finds those in contact.
class ZeroedForce {
 public:
  /// Returns the force that the sensor has measured before, if a program starts with this sample. Otherwise
  /// 0. Unit: N.
  double add(const Sample & sample)
  {
    const bool had_program = has_program_;
    has_program_ = sample.runtime_state != RuntimeState::stopped;
    if (has_program_) {
      return had_program ? 0.0 : force_;
    }
    force_ = length(position(sample.actual_tcp_force));
    return 0.0;
  }

 private:
  bool has_program_ = true;  // unknown
  double force_ = 0.0;
};

}  // namespace ur_ros_rtde
