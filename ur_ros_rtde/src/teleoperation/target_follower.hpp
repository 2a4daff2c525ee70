#pragma once

#include <memory>

#include "teleoperation/options.hpp"
#include "ur_ros_rtde/run.hpp"
#include "ur_ros_rtde_trajectory/arm_limits.hpp"

namespace ur_ros_rtde {

/// A target of a teleoperation message in UR values: joint positions (rad), a pose (position in m, rotation
/// vector in rad), or a twist (m/s, rad/s).
struct TeleopTarget {
  Vector6 values;
  bool in_tool_frame = false;  ///< of a twist
};

/// Converts the targets of one topic to one command per control cycle. Used by one thread.
class TargetFollower {
 public:
  virtual ~TargetFollower() = default;
  /// Whether a message with `target` asks the arm to move: a twist that is not zero; a position away from the
  /// arm, or not the one of the message before it (`before`, null if there is none). Any thread may call it.
  virtual bool moves(const TeleopTarget & target, const TeleopTarget * before,
                     const Sample & sample) const = 0;
  /// Starts at the current state. `cycle`: control period in s. `limits`: of the arm.
  virtual void begin(const Sample & sample, double cycle, const ArmLimits & limits) = 0;
  /// Sets the next target. `period`: s between messages. A failure ends the session.
  virtual Status set_target(const TeleopTarget & target, double period) = 0;
  /// Sends the command that is due `elapsed` s (controller time) after the previous one. A failure ends the
  /// session.
  virtual Status advance(Run & run, const Sample & sample, double elapsed) = 0;
};

/// For servo_joint and servo_pose. Moves along straight lines from target to target and arrives one and a
/// half periods after each message, so that the motion is steady at low message rates and does not halt for a
/// late message. Joint velocities stay within the limits of the arm, the TCP within 3 m/s and 3.14 rad/s.
/// Until the arm has reached the targets for the first time, the default speeds apply (default_speeds.hpp).
std::unique_ptr<TargetFollower> follow_joints(const TeleoperationOptions & options);
std::unique_ptr<TargetFollower> follow_poses(const TeleoperationOptions & options);
/// For twist. Applies the velocity of the newest message; in the tool frame, it turns with the tool.
std::unique_ptr<TargetFollower> follow_twists(const TeleoperationOptions & options);

}  // namespace ur_ros_rtde
