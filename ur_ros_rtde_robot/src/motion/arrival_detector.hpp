#pragma once

#include "ur_ros_rtde_robot/state/sample.hpp"

namespace ur_ros_rtde {

/// Proves from one package that the arm stands at the end of an asynchronous operation (a move or a stop), so
/// that a result does not have to wait for StandstillDetector::duration. In this package the operation has
/// ended, the target velocities are exactly zero, and every joint is slower than StandstillDetector::velocity
/// and closer to its target than `position`: the controller holds a constant target, and the arm is there.
///
/// The proof applies until the target moves, or the arm leaves it (a push, a compliant mode).
class ArrivalDetector {
 public:
  /// rad. An arm that still oscillates is slow for a moment where it is farthest from its target.
  static constexpr double position = 0.001;

  /// `operation_ended`: an asynchronous operation of the control program has ended with this package.
  void add(const Sample & sample, bool operation_ended);
  bool arrived() const { return arrived_; }

 private:
  bool operation_over_ = false;  ///< and the target has not moved since
  bool arrived_ = false;
};

}  // namespace ur_ros_rtde
