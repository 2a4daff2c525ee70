#pragma once

#include <deque>
#include <functional>
#include <vector>

#include "ur_ros_rtde/run.hpp"
#include "ur_ros_rtde_trajectory/stream_clock.hpp"

namespace ur_ros_rtde {

struct ServoSettings {
  double lookahead_time = 0.1;      ///< s, 0.03 to 0.2
  double gain = 600.0;              ///< 100 to 2000
  double max_tracking_error = 0.3;  ///< rad
  /// True when whoever ends the goal has said how to decelerate: then that is done, not along the path.
  std::function<bool()> stopped_by_another = [] { return false; };
};

/// Where the stream is, after each target.
struct StreamState {
  double time = 0.0;  ///< s, of the plan
  trajectory::Point desired;
  Sample sample;
  /// What the arm is behind: target less actual. It follows a target after about lookahead_time, so it is
  /// compared with the targets of the last lookahead_time and 0.1 s, and the nearest one counts.
  trajectory::Joints position_error, velocity_error;
  double tracking_error = 0.0;  ///< rad, of the joint that is farthest behind
};

/// Sends a plan to the controller as targets of servoJ, one with each of its packages, on a StreamClock. The
/// rate follows the controller's speed scaling and the speed slider, which servoJ itself ignores.
class ServoStream {
 public:
  /// Called after each target; what it refuses ends the stream.
  using Watch = std::function<Status(const trajectory::Trajectory &, const StreamState &)>;

  ServoStream(Run & run, ServoSettings settings, Watch watch);

  /// From the beginning of `plan`, where the arm is, to its last target. When the goal has to end meanwhile
  /// and the arm can still be moved, brakes along the path within `limits`, and returns why.
  Outcome drive(const trajectory::Trajectory & plan, const trajectory::Limits & limits);
  /// The arm has followed the last target; servo control ends.
  Outcome settle();

  double max_tracking_error() const { return largest_error_; }

 private:
  struct Target {
    double controller_time;
    trajectory::Joints position, velocity;
  };

  Status send(const trajectory::Trajectory & plan, double time);
  void measure();
  bool next_package();
  /// Sends the plan's targets until its end or until `enough`; false when the arm cannot be moved any more.
  bool keep_going(const trajectory::Trajectory & plan, const trajectory::Limits & limits,
                  trajectory::StreamClock & clock, const std::function<bool()> & enough);
  void brake(const trajectory::Trajectory & plan, const trajectory::Limits & limits,
             trajectory::StreamClock & clock);

  Run & run_;
  const ServoSettings settings_;
  const Watch watch_;
  const double cycle_;
  const double memory_;  // s, of the StreamClock
  StreamState state_;
  double elapsed_ = 0.0;  // s between the last two packages
  std::vector<double> target_;
  std::deque<Target> targets_;
  double largest_error_ = 0.0;
};

}  // namespace ur_ros_rtde
