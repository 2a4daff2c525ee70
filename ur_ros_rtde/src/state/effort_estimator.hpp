#pragma once

#include <array>

#include "ur_ros_rtde_robot/state/sample.hpp"

namespace ur_ros_rtde {

/// Estimates joint torques (Nm) from motor currents.
///
/// From PolyScope 5.23 on, the controller reports them (actual_current_as_torque). For older versions, the
/// ratio of torque to current of each joint is fitted to the controller's target values, which follow its
/// model of the arm: least squares through the origin of target_moment over target_current, with exponential
/// forgetting. The estimate is this ratio times the actual current. It contains friction and gear efficiency
/// as modelled by the controller.
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
