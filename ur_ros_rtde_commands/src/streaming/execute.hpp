#pragma once

#include <functional>
#include <stop_token>

#include "streaming/servo_stream.hpp"

namespace ur_ros_rtde {

/// A plan and the limits that it keeps, and that a stop or another speed is to keep.
struct Planned {
  trajectory::Trajectory trajectory;
  trajectory::Limits limits;
};

/// A trajectory from goal to standstill.
struct Execution {
  /// Plans, from where the arm stands; in a thread of its own. Looks at the stop_token now and then.
  std::function<Expected<Planned>(const trajectory::Joints & start, std::stop_token)> plan;
  ServoSettings servo;
  double start_tolerance = 0.01;  ///< rad, of the plan's beginning from where the arm is
  bool approach = false;          ///< go to the beginning first, however far it is
  double speed_fraction = 1.0;    ///< of the approach, as of the plan
  /// Once, when the plan stands and before anything moves.
  std::function<void(const trajectory::Trajectory &)> planned = [](const trajectory::Trajectory &) {};
  /// After each target of the plan; what it refuses ends the goal.
  ServoStream::Watch watch = [](const trajectory::Trajectory &, const StreamState &) { return Status(); };
  /// When the plan's last target has been sent: waits until the arm has followed it. None: ServoStream's way.
  std::function<Outcome()> arrive;
};

struct ExecutionResult {
  Outcome outcome;
  double max_tracking_error = 0.0;  ///< rad
};

/// Plans, looks whether the arm is where the plan begins, goes the last bit (or the approach) by a plan of
/// its own within the same limits, but never faster than slow_limits(), and sends both.
ExecutionResult execute(Run & run, const Execution & execution);

/// Where the controller has the arm: its target, without the noise of measurement.
trajectory::Joints commanded_joints(const Sample & sample);

/// Refused when `first` is farther than `tolerance` from `here` in any joint.
Status check_start_position(const trajectory::Joints & first, const trajectory::Joints & here,
                            double tolerance);

}  // namespace ur_ros_rtde
