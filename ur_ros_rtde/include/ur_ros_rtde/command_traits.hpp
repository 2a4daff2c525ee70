#pragma once

#include "ur_ros_rtde_robot/motion/arbiter.hpp"

namespace ur_ros_rtde {

/// How the goals of a command share the robot with other goals.
struct CommandTraits {
  /// What no other goal may use at the same time. `motion` for everything that moves the arm or must not
  /// happen during a motion; `none` for what may happen at any time.
  Resource resource = Resource::motion;
  /// Preempts the goal that holds the resource instead of being rejected as busy, and needs no more than a
  /// connection: a stop.
  bool preempts_all = false;
  /// A new goal preempts the active goal of the same action instead of being rejected as busy.
  bool preempts_self = false;
  /// Switches a mode of the arm on or off that outlasts the goal (freedrive_start): after success the arm is
  /// left as it is, moving or not.
  bool leaves_mode_active = false;
  /// Accepts and executes goals in every state of the robot; needs the dashboard server only.
  bool allowed_in_any_state = false;
};

}  // namespace ur_ros_rtde
