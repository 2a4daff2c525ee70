#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "ur_ros_rtde/run.hpp"
#include "ur_ros_rtde_trajectory/arm_limits.hpp"

namespace ur_ros_rtde {

/// How the arm follows a TargetStream, and when the stream ends.
struct StreamOptions {
  double timeout = 0.1;  ///< s without a target that end the stream
  double max_joint_jump =
      0.2;  ///< rad, largest distance of a target from the last command; also for the rotation of a pose
  double max_linear_jump = 0.1;  ///< m, the same for the position of a pose
  double acceleration = 1.0;     ///< m/s^2, for twists
  double deceleration = 2.0;     ///< rad/s^2, m/s^2, for the stop at the end of the stream
  double lookahead_time = 0.1;   ///< s, servo control
  double gain = 300.0;           ///< servo control

  /// For Run::stop_motion(), with `deceleration`.
  StopOptions stop_options() const
  {
    StopOptions options;
    options.joint_deceleration = deceleration;
    options.linear_deceleration = deceleration;
    return options;
  }
};

/// A target in UR values: joint positions (rad), a pose of the TCP in the base frame (position in m, rotation
/// vector in rad), or a twist (m/s, rad/s). target_messages.hpp makes targets of messages.
struct StreamTarget {
  Vector6 values;
  bool in_tool_frame = false;  ///< of a twist
};

/// Converts targets of one kind to one command per control cycle. Used by one thread, unless stated
/// otherwise.
class TargetFollower {
 public:
  virtual ~TargetFollower() = default;
  /// Whether `target` asks the arm to move: a twist that is not zero; a position away from the arm, or not
  /// the one before it (`before`, null if there is none). Any thread may call it.
  virtual bool moves(const StreamTarget & target, const StreamTarget * before,
                     const Sample & sample) const = 0;
  /// Starts at the current state. `cycle`: control period in s. `limits`: of the arm.
  virtual void begin(const Sample & sample, double cycle, const ArmLimits & limits) = 0;
  /// Sets the next target. `period`: s between targets. A failure ends the stream.
  virtual Status set_target(const StreamTarget & target, double period) = 0;
  /// Sends the command that is due `elapsed` s (controller time) after the previous one. A failure ends the
  /// stream.
  virtual Status advance(Run & run, const Sample & sample, double elapsed) = 0;
};

/// For joint positions and for poses. Moves along straight lines from target to target and arrives one and a
/// half periods after each, so that the motion is steady at low rates and does not halt for a late target.
/// Joint velocities stay within the limits of the arm (for poses, see check_joint_velocities()), the TCP
/// within 3 m/s and 3.14 rad/s. Until the arm has reached the targets for the first time, the default speeds
/// apply (default_speeds.hpp).
std::unique_ptr<TargetFollower> follow_joints(const StreamOptions & options);
std::unique_ptr<TargetFollower> follow_poses(const StreamOptions & options);
/// For twists. Applies the velocity of the newest target; in the tool frame, it turns with the tool.
std::unique_ptr<TargetFollower> follow_twists(const StreamOptions & options);
/// For targets in Cartesian space, the controller computes the joint velocities, which become large close to
/// a singularity. Fails (safety_violation) once one exceeds its limit: the stop begins in the same cycle.
Status check_joint_velocities(const Sample & sample, const ArmLimits & limits);

/// The smoothed time between targets.
class TargetPeriod {
 public:
  /// s, after a target that arrived `interval` s after the last one. Longer than `timeout`: it is the first
  /// one.
  double next(double interval, double timeout);
  /// s, what next() has returned last. 0: it was not called.
  double seconds() const { return period_; }

 private:
  double period_ = 0.0;
};

/// The arm follows targets that a command computes or receives while it runs (a camera, a force controller),
/// at any rate. The topics servo_joint, servo_pose and twist are streams as well.
///
///     TargetStream stream(run, follow_poses(options), options);
///     while (!arrived) {
///       if (auto why = stream.wait()) { return *why; }                            // for the next package
///       if (there_is_a_new_target) {
///         if (Status valid = stream.set(target); !valid) { return valid; }        // too far away
///       }
///       if (Status sent = stream.send(); !sent) { return sent; }                  // no target in time
///     }
///     return run.stop_motion(options.stop_options());
///
/// However the goal or the stream ends, the arm decelerates: the destructor stops it with
/// StreamOptions::deceleration. After a delay of the host, the motion goes on from the last
/// command: slower, never faster.
class TargetStream {
 public:
  /// Starts at the current state, where the arm stays until the first target. `run` outlives this object.
  TargetStream(Run & run, std::unique_ptr<TargetFollower> follower, const StreamOptions & options);
  /// The same with a follower that outlives this object.
  TargetStream(Run & run, TargetFollower & follower, const StreamOptions & options);
  /// A failure to stop the arm is a warning of the goal.
  ~TargetStream();
  TargetStream(const TargetStream &) = delete;
  TargetStream & operator=(const TargetStream &) = delete;

  /// Waits for the next package; see Run::next().
  [[nodiscard]] std::optional<StopReason> wait();
  /// Sets the next target. Fails (invalid_goal) if it is too far from the last command. `period`: s between
  /// targets; without it, the time since the last one, smoothed.
  [[nodiscard]] Status set(const StreamTarget & target);
  [[nodiscard]] Status set(const StreamTarget & target, double period);
  /// Sends the command of this cycle. Fails (timeout) if there has been no target for StreamOptions::timeout,
  /// and close to a singularity (safety_violation). Throws RobotError (busy) if another thread keeps the
  /// control interface for longer than that.
  [[nodiscard]] Status send();

  /// The newest package.
  const Sample & sample() const { return sample_; }

 private:
  using Clock = std::chrono::steady_clock;

  Run & run_;
  std::unique_ptr<TargetFollower> own_follower_;
  TargetFollower & follower_;
  const StreamOptions options_;
  const double cycle_;
  Sample sample_;
  std::chrono::milliseconds control_timeout_;  // of Run before this stream
  double elapsed_ = 0.0;                       // s between the last two packages
  TargetPeriod period_;
  Clock::time_point last_target_ = Clock::now();
  bool has_target_ = false;
};

}  // namespace ur_ros_rtde
