#pragma once

#include <deque>
#include <functional>
#include <vector>

#include "streaming/servo_setpoint.hpp"
#include "ur_ros_rtde/run.hpp"
#include "ur_ros_rtde_robot/motion/setpoint_clock.hpp"
#include "ur_ros_rtde_trajectory/time_scaling.hpp"

namespace ur_ros_rtde {

struct ServoSettings {
  ServoParameters parameters;
  double max_tracking_error = 0.3;  ///< rad
};

/// The state of the stream after each setpoint.
struct StreamState {
  double time = 0.0;    ///< s since the start of the trajectory
  JointMotion desired;  ///< at the rate of the time axis: slower than the plan if the robot is
  Sample sample;
  /// Desired minus actual value. The setpoints make the arm follow the plan without delay. On a robot that is
  /// slower, it is compared with the nearest desired position of the last lookahead_time + 0.1 s.
  trajectory::Joints position_error, velocity_error;
  double tracking_error = 0.0;  ///< rad, the largest of all joints
};

/// Sends a plan to the controller as setpoints of servoJ, one with each of its packages, on a TimeScaling.
/// The rate follows the controller's speed scaling and the speed slider, which servoJ itself ignores. Each
/// setpoint carries its time in cycles of the controller, with which the control program bridges late ones.
class ServoStream {
 public:
  /// Called after each setpoint. A failure ends the stream, unless it brakes already.
  using SetpointCallback = std::function<Status(const trajectory::Trajectory &, const StreamState &)>;

  ServoStream(Run & run, ServoSettings settings, SetpointCallback on_setpoint);

  /// Streams `plan`, which starts at the position of the arm. If the goal has to end before, brakes along the
  /// path, unless a stop takes the arm, and returns the reason: within `limits`, or, if no such stop is found
  /// in 4 ms, by slowing down its time scaling.
  Outcome execute(const trajectory::Trajectory & plan, const trajectory::Limits & limits);
  /// Waits until the arm has followed the last setpoint, then ends servo control.
  Outcome finish();

  double max_tracking_error() const { return max_tracking_error_; }

 private:
  struct Target {
    double controller_time;
    trajectory::Joints position, velocity;
  };

  Status send(const trajectory::Trajectory & plan, const trajectory::Limits & limits,
              const trajectory::TimeScaling & time_scaling);
  void update_tracking_error();
  bool next_package();
  void add_elapsed(double before);
  trajectory::TimeScaling make_time_scaling(double rate, double time = 0.0) const;
  void brake(const Run::Braking & braking, const trajectory::Trajectory & plan,
             const trajectory::Limits & limits, const trajectory::TimeScaling & time_scaling);
  /// Streams `stop`, a trajectory that ends at rest.
  void follow(const Run::Braking & braking, const trajectory::Trajectory & stop,
              const trajectory::Limits & limits, double time);
  void slow_down(const Run::Braking & braking, const trajectory::Trajectory & plan,
                 const trajectory::Limits & limits, trajectory::TimeScaling time_scaling);

  Run & run_;
  const ServoSettings settings_;
  const SetpointCallback on_setpoint_;
  const double cycle_;
  StreamState state_;
  double elapsed_ = 0.0;  // s by which the last setpoint advances the plan
  SetpointClock clock_;
  std::vector<double> target_;
  std::deque<Target> targets_;
  double max_tracking_error_ = 0.0;
};

}  // namespace ur_ros_rtde
