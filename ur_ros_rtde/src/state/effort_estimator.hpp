#pragma once

#include <array>

#include "ur_ros_rtde_robot/state/sample.hpp"

namespace ur_ros_rtde {

/// Joint torques, Nm, from the motor currents.
///
/// From PolyScope 5.23 on the controller reports them itself (actual_current_as_torque). Before, the ratio of
/// torque to current of each joint is learnt from the controller's own target values, which follow its model
/// of the arm: least squares through zero of target_moment over target_current, older samples fading; the
/// estimate is that ratio times the actual current. Friction and the gear's efficiency are in it as the
/// model has them.
class EffortEstimator {
 public:
  Vector6 update(const Sample & sample);

 private:
  struct Ratio {
    double moment_current = 0.0;
    double current_current = 0.0;
  };
  std::array<Ratio, 6> ratios_;
};

}  // namespace ur_ros_rtde
