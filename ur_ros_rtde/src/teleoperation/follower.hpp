#pragma once

#include <memory>

#include "teleoperation/options.hpp"
#include "ur_ros_rtde/run.hpp"
#include "ur_ros_rtde_trajectory/arm_limits.hpp"

namespace ur_ros_rtde {

/// What a message asks for, in UR's values: joint positions (rad), a pose (m, rotation vector), or a twist
/// (m/s, rad/s).
struct StreamTarget {
  Vector6 values;
  bool in_tool_frame = false;  ///< of a twist
};

/// Turns the targets of one stream into commands, one in each control cycle. Used by one thread.
class Follower {
 public:
  virtual ~Follower() = default;
  /// A stream begins; `cycle` of the controller, s; `limits` of the arm.
  virtual void begin(const Sample & sample, double cycle, const ArmLimits & limits) = 0;
  /// The next target; the messages come `period` s apart. What is refused ends the stream.
  virtual Status aim(const StreamTarget & target, double period) = 0;
  /// Sends what belongs `elapsed` s of the controller's clock after the command before. What is refused ends
  /// the stream.
  virtual Status advance(Run & run, const Sample & sample, double elapsed) = 0;
};

/// servo_joint, servo_pose: from target to target along straight lines, so as to arrive one and a half
/// periods after the message: slow messages make a steady motion, and one that is late no halt. Never faster
/// than the joints, or 3 m/s and 3.14 rad/s, allow; at the default speeds (default_speeds.hpp) until the arm
/// has caught up with the stream for the first time.
std::unique_ptr<Follower> follow_joints(const TeleoperationOptions & options);
std::unique_ptr<Follower> follow_poses(const TeleoperationOptions & options);
/// twist: the velocity of the newest message, in the tool's frame as the tool turns.
std::unique_ptr<Follower> follow_twists(const TeleoperationOptions & options);

}  // namespace ur_ros_rtde
