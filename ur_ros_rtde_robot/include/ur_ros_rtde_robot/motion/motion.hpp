#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "ur_ros_rtde_robot/state/sample.hpp"

namespace ur_ros_rtde {

/// The situation before a command, against which MotionProgress is measured. ur_rtde's status word of the
/// last asynchronous operation stays as it was until the next one begins, so "not running" alone does not
/// mean "ended".
struct MotionMark {
  AsyncStatus async;
  std::uint32_t program = 0;  ///< counts the ends of robot programs
};

struct MotionProgress {
  bool started = false;  ///< an asynchronous operation has begun since the mark (it may have ended already)
  bool running = false;  ///< the control script is still at it
  bool at_rest = false;  ///< all joints have stood still for some cycles
  bool program_ended = false;  ///< the robot program has ended since the mark, and the motion with it
  unsigned progress = 0;       ///< of a path: index of the waypoint under way
  bool finished() const { return started && !running && at_rest && !program_ended; }
};

enum class StopMeans {
  nothing_moved,     ///< the arm stood still and nothing was under way
  stop_command,      ///< the control script decelerated it
  program_stopped,   ///< the robot program was stopped; the robot decelerates
  stopped_by_robot,  ///< a protective, safeguard or emergency stop had done it
};

const char * to_string(StopMeans means);

struct StopOptions {
  /// rad/s^2 for joint motion (stopj), m/s^2 for Cartesian motion (stopl); sensible: 0.5 to 10.
  double joint_deceleration = 2.0;
  double linear_deceleration = 2.0;
  /// For the deceleration as commanded; then the program is stopped.
  std::chrono::milliseconds limit{3000};
  /// For the arm to stand still after the program was stopped.
  std::chrono::milliseconds program_stop_limit{1500};
};

struct StopReport {
  StopMeans means = StopMeans::nothing_moved;
  /// s of controller time from the request to standstill.
  double time_to_standstill = 0.0;
};

/// Standstill by actual joint velocities, over samples of consecutive cycles.
class StandstillDetector {
 public:
  /// rad/s below which a joint counts as still (sensor noise is below 0.005), and how long it must last.
  static constexpr double velocity = 0.01;
  static constexpr double duration = 0.02;

  void add(const Sample & sample);
  void reset() { quiet_since_.reset(); }
  bool at_rest() const { return at_rest_; }

 private:
  std::optional<double> quiet_since_;
  std::uint32_t link_ = 0;
  bool at_rest_ = false;
};

}  // namespace ur_ros_rtde
