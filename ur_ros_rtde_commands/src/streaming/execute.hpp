#pragma once

#include <functional>
#include <stop_token>

#include "streaming/servo_stream.hpp"

namespace ur_ros_rtde {

/// A planned trajectory and the limits that it satisfies. Stops and speed changes must satisfy them, too.
struct PlannedTrajectory {
  trajectory::Trajectory trajectory;
  trajectory::Limits limits;
};

/// How to plan and execute the trajectory of a goal.
struct Execution {
  /// Plans from the current joint positions, in a separate thread. Has to check the stop_token regularly.
  std::function<Expected<PlannedTrajectory>(const trajectory::Joints & start, std::stop_token)> plan;
  ServoSettings servo;
  double start_tolerance = 0.01;  ///< rad, maximum distance of the arm from the start of the trajectory
  bool approach = false;          ///< move to the start of the trajectory first, from any distance
  double speed_fraction = 1.0;    ///< of the approach and of the trajectory
  /// Called once after planning, before any motion.
  std::function<void(const trajectory::Trajectory &)> on_planned = [](const trajectory::Trajectory &) {};
  /// Waits, after planning, for the moment at which the motion begins.
  std::function<Outcome()> wait_for_start = [] { return Outcome::success(); };
  /// Called after each setpoint. A failure ends the goal.
  ServoStream::SetpointCallback on_setpoint = [](const trajectory::Trajectory &, const StreamState &) {
    return Status();
  };
  /// Waits until the arm has followed the last setpoint. Default: ServoStream::finish().
  std::function<Outcome()> wait_for_arrival;
};

struct ExecutionResult {
  Outcome outcome;
  double max_tracking_error = 0.0;  ///< rad
};

/// Plans the trajectory, checks that the arm is at its start, and streams it. A remaining distance to the
/// start (or the approach) is planned separately within the same limits, and not faster than
/// default_speed_limits().
ExecutionResult execute(Run & run, const Execution & execution);

/// The target positions of the controller, which contain no measurement noise.
trajectory::Joints commanded_joints(const Sample & sample);

/// Fails if `first` differs from `current` by more than `tolerance` (rad) in any joint.
Status check_start_position(const trajectory::Joints & first, const trajectory::Joints & current,
                            double tolerance);

}  // namespace ur_ros_rtde
