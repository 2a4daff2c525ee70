#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "common/types.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

struct RobotModel;

/// Identifies one motion since the controller started; never reused.
using MotionId = std::uint64_t;
/// The identifier, or why the robot refuses the motion, as a robot would say it on its log.
using MotionStart = tl::expected<MotionId, std::string>;

/// Options of movej and movel: leading-axis acceleration (rad/s^2, m/s^2) and speed (rad/s, m/s), time (s, 0 = by speed),
/// blend radius (m).
struct MoveOptions {
  double acceleration;
  double velocity;
  double time = 0.0;
  double blend_radius = 0.0;
};

/// The arm's motion generator: one motion at a time, advanced one control cycle at a time. A new motion takes over from the one
/// before at its present position and velocity. Starts are refused (never throw) for unreachable, non-finite or limit-breaking
/// targets. Nothing moves unless the robot mode is RUNNING.
class Arm {
 public:
  Arm(const RobotModel & model, double cycle_time, const Vector6 & initial_position);
  ~Arm();
  Arm(const Arm &) = delete;
  Arm & operator=(const Arm &) = delete;

  MotionStart move_joint(const Vector6 & target, const MoveOptions & options);
  MotionStart move_linear(const Vector6 & tcp_pose, const MoveOptions & options);
  /// servoj: `time` s the call controls the robot, `lookahead` 0.03..0.2 s, `gain` 100..2000.
  MotionStart servo_joint(const Vector6 & target, double time, double lookahead, double gain);
  /// speedj / speedl: `time` 0 = until another motion; decelerates by itself when time is up and nothing follows.
  MotionStart speed_joint(const Vector6 & velocity, double acceleration, double time);
  MotionStart speed_linear(const Vector6 & tcp_twist, double acceleration, double time);
  MotionStart stop_joint(double deceleration);
  MotionStart stop_linear(double deceleration);

  /// Has this motion ended (reached its target, been replaced or abandoned)?
  bool finished(MotionId motion) const;
  /// Is this the motion that the arm executes now?
  bool active(MotionId motion) const;
  /// A motion whose program ended or was killed: the arm decelerates along its path to standstill.
  void abandon(MotionId motion);
  /// As a protective stop or a program stop does: brake whatever moves, hard or within limits, and forget it.
  void halt(double deceleration);
  bool at_rest() const;

  /// Advances one cycle: writes the target and actual joint state and the TCP poses and speeds.
  void step(ControllerState & state);
  /// Puts the arm elsewhere at once, at rest (test set-up only).
  void teleport(const Vector6 & position, ControllerState & state);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ur_simulator
