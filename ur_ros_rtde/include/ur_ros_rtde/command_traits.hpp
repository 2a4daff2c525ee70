#pragma once

#include "ur_ros_rtde_robot/motion/lease.hpp"

namespace ur_ros_rtde {

/// How the goals of a command share the robot with other goals.
struct CommandTraits {
  /// What no other goal may use at the same time. `motion` for everything that moves the arm or must not
  /// happen during a motion; `mode` for a mode that may be switched on during a motion; `none` for what may
  /// happen at any time and does not move the arm.
  Resource resource = Resource::motion;
  /// A stop: when a goal arrives, the arm is taken out of the hands of all others and decelerates as
  /// Command::stop_options() says. Accepted in every state of the robot.
  bool preempts_all = false;
  /// Stops the arm by what Command::run() does (a protective stop). Its goals are served like those of a
  /// stop: without waiting for the checks of other commands, beside the limit of goals, in every state of the
  /// robot, and to their end if the client disappears.
  bool stops_arm = false;
  /// A new goal preempts the active goal of the same action instead of being rejected as busy.
  bool preempts_self = false;
  /// Switches force mode, freedrive or teach mode on or off, which outlasts the goal (freedrive_start): after
  /// success, the mode and the arm are left as they are. What else the goal has started is stopped at its
  /// end. If the goal has a field `bool outlives_client` that is false, the mode ends with the client.
  bool leaves_mode_active = false;
  /// Switches freedrive or teach mode on or off: its goals are accepted while the arm is guided by hand.
  bool switches_hand_guiding = false;
  /// Changes what force mode relies on (payload, TCP, gravity, the sensor): rejected (busy) during it.
  bool excludes_force_mode = false;
  /// Accepts and executes goals in every state of the robot; needs the dashboard server only.
  bool allowed_in_any_state = false;
  /// The control program cannot answer queries during a goal.
  bool blocks_queries = false;
};

}  // namespace ur_ros_rtde
