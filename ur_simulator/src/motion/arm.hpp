#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "common/types.hpp"
#include "motion/force_mode.hpp"
#include "motion/tcp_leg.hpp"
#include "state/controller_state.hpp"
#include "state/faults.hpp"

namespace ur_simulator {

struct RobotModel;

/// Identifies one motion since the controller started; never reused.
using MotionId = std::uint64_t;
/// The identifier, or why the robot refuses the motion, as a robot would say it on its log.
using MotionStart = tl::expected<MotionId, std::string>;
/// Of a motion that is none: its call returns at once.
constexpr MotionId skipped_motion = 0;

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

  // Motions to a target. With a blend radius the call may return when the TCP is that near to its target
  // (movej, movel, optimove*: half of the way at most): what starts then is blended in; if nothing does, the
  // motion ends at its target. One whose blend would overlap with that of the motion before is skipped.
  MotionStart move_joint(const Vector6 & target, const MoveOptions & options);
  MotionStart move_linear(const Vector6 & tcp_pose, const MoveOptions & options);
  /// optimovej, optimovel: acceleration and velocity are fractions (0 < f <= 1) of the highest on this path.
  MotionStart move_joint_optimally(const Vector6 & target, const MoveOptions & options);
  MotionStart move_linear_optimally(const Vector6 & tcp_pose, const MoveOptions & options);
  /// movep: constant tool speed, through the blends of movep with movep too, which are arcs.
  MotionStart move_process(const Vector6 & tcp_pose, const MoveOptions & options);
  /// movec: on the circle through where the TCP is (of a motion in its blend: will be), `via` and the target.
  MotionStart move_circular(const Vector6 & via, const Vector6 & tcp_pose, CircleMode mode,
                            const MoveOptions & options);
  /// servoc: from the present velocity on the circle that leads to the target.
  MotionStart servo_circular(const Vector6 & tcp_pose, const MoveOptions & options);
  /// servoj: `time` s the call controls the robot, `lookahead` 0.03..0.2 s, `gain` 100..2000. The arm tracks
  /// the target as long as nothing else follows, also when the time is up.
  MotionStart servo_joint(const Vector6 & target, double time, double lookahead, double gain);
  /// speedj / speedl: `time` 0 = until another motion; decelerates by itself when time is up and nothing
  /// follows.
  MotionStart speed_joint(const Vector6 & velocity, double acceleration, double time);
  MotionStart speed_linear(const Vector6 & tcp_twist, double acceleration, double time);
  MotionStart stop_joint(double deceleration);
  MotionStart stop_linear(double deceleration);

  /// force_mode(): from now on compliance is superposed on all that the program moves, until end_force_mode()
  /// or end_program(). A further call changes the settings on the way. Stops suspend it.
  tl::expected<void, std::string> start_force_mode(const ForceModeSettings & settings);
  /// The arm decelerates along the compliant axes; a motion of the program ends where it is (a movel is begun
  /// anew by its operation).
  void end_force_mode();
  bool in_force_mode() const;
  /// 0..2 and 0..1, for the program that runs.
  void set_force_mode_scaling(double scaling);
  void set_force_mode_damping(double damping);
  /// freedrive_mode(): hands lead the arm along and about the free axes of the feature (a pose in the base
  /// frame) until end_freedrive(), the program's end or a stop. Motions of the program are refused meanwhile.
  MotionStart freedrive(const std::array<bool, 6> & free_axes, const Vector6 & feature);
  void end_freedrive();
  /// direct_torque(): N m for the next cycle, gravity compensated; parts (0..1) of the friction that the
  /// controller compensates.
  MotionStart direct_torque(const Vector6 & torque, const Vector6 & viscous_scale,
                            const Vector6 & coulomb_scale);
  /// The program ended: force mode, freedrive and their settings end with it.
  void end_program();

  /// May the URScript call that started this motion return? Paths: at the target, in the blend; stopj, stopl:
  /// standstill; servoj: its time is up; speedj, speedl: time is up or, without one, the velocity is reached.
  /// Also when replaced, abandoned, stopped by safety.
  bool finished(MotionId motion) const;
  /// Has it come to its blend, and is it going on to its target?
  bool in_blend(MotionId motion) const;
  /// Is it the last motion that went all its way, neither abandoned nor stopped by safety? The joints'
  /// position does not tell: along the compliant axes force mode keeps them away from the target.
  bool arrived(MotionId motion) const;
  /// Where the path begins and leads that the arm follows, TCP poses; nothing when it follows none.
  struct PathEnds {
    Vector6 start;
    Vector6 target;
  };
  std::optional<PathEnds> path_ends() const;
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
