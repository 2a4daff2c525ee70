#pragma once

#include <deque>
#include <functional>
#include <vector>

#include "ur_ros_rtde/run.hpp"
#include "ur_ros_rtde_trajectory/time_scaling.hpp"

namespace ur_ros_rtde {

struct ServoSettings {
  double lookahead_time = 0.1;      ///< s, 0.03 to 0.2
  double gain = 600.0;              ///< 100 to 2000
  double max_tracking_error = 0.3;  ///< rad
  /// True if the goal was preempted by a command that determines the deceleration. The arm then does not
  /// brake along the path.
  std::function<bool()> preempted_by_stop = [] { return false; };
};

/// The state of the stream after each setpoint.
struct StreamState {
  double time = 0.0;  ///< s since the start of the trajectory
  trajectory::Point desired;
  Sample sample;
  /// Setpoint minus actual value. The arm follows a setpoint after about lookahead_time, so it is compared
  /// with the nearest setpoint of the last lookahead_time + 0.1 s.
  trajectory::Joints position_error, velocity_error;
  double tracking_error = 0.0;  ///< rad, the largest of all joints
};

/// Sends a plan to the controller as targets of servoJ, one with each of its packages, on a TimeScaling. The
/// rate follows the controller's speed scaling and the speed slider, which servoJ itself ignores.
class ServoStream {
 public:
  /// Called after each setpoint. A failure ends the stream.
  using SetpointCallback = std::function<Status(const trajectory::Trajectory &, const StreamState &)>;

  ServoStream(Run & run, ServoSettings settings, SetpointCallback on_setpoint);

  /// Streams `plan`, which starts at the position of the arm. If the goal has to stop meanwhile and the arm
  /// can still move, brakes along the path within `limits` and returns the reason.
  Outcome execute(const trajectory::Trajectory & plan, const trajectory::Limits & limits);
  /// Waits until the arm has followed the last setpoint, then ends servo control.
  Outcome settle();

  double max_tracking_error() const { return max_tracking_error_; }

 private:
  struct Target {
    double controller_time;
    trajectory::Joints position, velocity;
  };

  Status send(const trajectory::Trajectory & plan, double time);
  void update_tracking_error();
  bool next_package();
  /// Streams the plan until its end or until `done`. False if the arm can no longer be moved.
  bool continue_until(const trajectory::Trajectory & plan, const trajectory::Limits & limits,
                      trajectory::TimeScaling & time_scaling, const std::function<bool()> & done);
  void brake(const trajectory::Trajectory & plan, const trajectory::Limits & limits,
             trajectory::TimeScaling & time_scaling);

  Run & run_;
  const ServoSettings settings_;
  const SetpointCallback on_setpoint_;
  const double cycle_;
  const double servo_lag_;  // s, the time that the arm takes to follow a setpoint
  StreamState state_;
  double elapsed_ = 0.0;  // s between the last two packages
  std::vector<double> target_;
  std::deque<Target> targets_;
  double max_tracking_error_ = 0.0;
};

}  // namespace ur_ros_rtde
