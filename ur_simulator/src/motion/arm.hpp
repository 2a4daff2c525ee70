#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "common/types.hpp"
#include "state/controller_state.hpp"
#include "state/faults.hpp"

namespace ur_simulator {

struct RobotModel;

/// Identifies one motion since the controller started; never reused.
using MotionId = std::uint64_t;
/// The identifier, or why the robot refuses the motion, as a robot would say it on its log.
using MotionStart = tl::expected<MotionId, std::string>;

/// Options of movej and movel: leading-axis acceleration (rad/s^2, m/s^2) and speed (rad/s, m/s), time (s, 0
/// = by speed), blend radius (m).
struct MoveOptions {
  double acceleration;
  double velocity;
  double time = 0.0;
  double blend_radius = 0.0;
};

/// The arm's motion generator: one motion at a time, advanced one control cycle at a time. A new motion takes
/// over from the one before at its present position and velocity. Starts are refused (never throw) for
/// unreachable, non-finite or limit-breaking targets. Nothing moves unless the robot mode is RUNNING and the
/// safety mode NORMAL, REDUCED or RECOVERY.
/// The state given to step() or teleport() must outlive the arm: its modes and its TCP offset hold for what
/// starts next (Cartesian motions lead the TCP that was set when they started, to their end).
class Arm {
 public:
  Arm(const RobotModel & model, double cycle_time, const Vector6 & initial_position);
  ~Arm();
  Arm(const Arm &) = delete;
  Arm & operator=(const Arm &) = delete;

  MotionStart move_joint(const Vector6 & target, const MoveOptions & options);
  MotionStart move_linear(const Vector6 & tcp_pose, const MoveOptions & options);
  /// servoj: `time` s the call controls the robot, `lookahead` 0.03..0.2 s, `gain` 100..2000. The arm tracks
  /// the target as long as nothing else follows, also when the time is up.
  MotionStart servo_joint(const Vector6 & target, double time, double lookahead, double gain);
  /// speedj / speedl: `time` 0 = until another motion; decelerates by itself when time is up and nothing
  /// follows.
  MotionStart speed_joint(const Vector6 & velocity, double acceleration, double time);
  MotionStart speed_linear(const Vector6 & tcp_twist, double acceleration, double time);
  MotionStart stop_joint(double deceleration);
  MotionStart stop_linear(double deceleration);

  /// May the URScript call that started this motion return? movej, movel: target reached; stopj, stopl:
  /// standstill; servoj: its time is up; speedj, speedl: time is up or, without one, the velocity is reached.
  /// Also when replaced, abandoned, stopped by safety.
  bool finished(MotionId motion) const;
  /// Is this the motion that the arm executes now? (servoj and speedj may be active and finished.)
  bool active(MotionId motion) const;
  /// A motion whose program ended or was killed: the arm decelerates along its path to standstill.
  void abandon(MotionId motion);
  /// Whatever moves, as abandon().
  void abandon_all();
  /// As a protective stop or a program stop does: brake whatever moves at `deceleration` (rad/s^2 of the
  /// fastest joint), and forget it.
  void halt(double deceleration);
  /// Target and actual joints stand still and nothing is being executed.
  bool at_rest() const;

  /// Pausing ramps the speed scaling down to 0 and keeps the motion; resuming ramps it up again. speedj and
  /// speedl end.
  void pause();
  void resume();

  /// Why the arm gave up a motion since the last call: to be handed to Safety::trip().
  std::optional<MotionFault> take_fault();

  /// Advances one cycle: writes the target and actual joint state (with torques and currents), the TCP poses
  /// and speeds, the tool's acceleration and the speed scaling.
  void step(ControllerState & state);
  /// Puts the arm elsewhere at once, at rest (test set-up only). The position must be finite and within
  /// limits, else std::invalid_argument.
  void teleport(const Vector6 & position, ControllerState & state);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ur_simulator
