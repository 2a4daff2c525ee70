#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "ur_ros_rtde_robot/motion/activity.hpp"
#include "ur_ros_rtde_robot/state/sample.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Motion state before a command, the reference for MotionProgress. ur_rtde keeps the status word of the last
/// asynchronous operation until the next one begins, so "not running" alone does not mean "ended".
struct MotionMark {
  AsyncStatus async;
  std::uint32_t program = 0;  ///< number of robot programs that have ended
  std::uint32_t moves = 0;    ///< number of moves that have been sent to this program
};

/// What has happened to a motion since a MotionMark.
struct MotionProgress {
  bool started = false;        ///< an asynchronous operation has begun since the mark; it may have ended
  bool running = false;        ///< the asynchronous operation is running
  bool at_rest = false;        ///< proven: for several cycles, or at the end of an asynchronous operation
  bool program_ended = false;  ///< the robot program has ended since the mark, which ends the motion
  unsigned progress = 0;       ///< index of the current waypoint of a path
  /// At rest or not, which it is not if force mode moves the arm.
  bool ended() const { return started && !running && !program_ended; }
  /// The same, and at rest.
  bool finished() const { return ended() && at_rest; }
};

/// What stopped the arm, in the order in which a stop takes them: docs/internals/goals.md, "Means of a stop".
enum class StopMeans {
  nothing_moved,     ///< the arm was at rest and nothing was started
  stopped_by_robot,  ///< a protective, safeguard or emergency stop, or the end of its program
  stop_command,      ///< the control program decelerated the arm as requested
  program_stopped,   ///< the program was stopped through the dashboard server; the controller decelerated the
                     ///< arm
  watchdog,          ///< the heartbeat was ended; the watchdog of the program stopped it
};

const char * to_string(StopMeans means);

/// How the arm is stopped.
struct StopOptions {
  /// rad/s^2 for motions in joint space (stopj), m/s^2 for others (stopl); useful range: 0.5 to 10.
  double joint_deceleration = 2.0;
  double linear_deceleration = 2.0;
  /// Time allowed for the commanded deceleration. After that, or if the arm does not decelerate, the program
  /// is stopped. Empty: as long as the deceleration takes, with a reserve.
  std::optional<std::chrono::milliseconds> timeout;
  /// Modes that stay on.
  Activities keep;
  /// Ends also a program that is not the driver's and plays, even while it stands: it may move the arm again.
  bool ends_foreign_program = false;
  bool operator==(const StopOptions &) const = default;
};

/// How the arm was stopped.
struct StopReport {
  StopMeans means = StopMeans::nothing_moved;
  /// s, controller time from the request to standstill.
  double time_to_standstill = 0.0;
};

// For the driver

/// Of a success, if the stop of the arm fails with `stop`; of what ends because of `why`.
Error standstill_not_confirmed(const Error & stop);
Error standstill_not_confirmed(const Error & why, const Error & stop);

/// Detects standstill from the actual joint velocities of consecutive samples.
class StandstillDetector {
 public:
  /// rad/s, below which a joint is at rest (sensor noise is below 0.005), and s, for which it must last.
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
