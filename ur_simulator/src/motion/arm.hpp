#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "common/types.hpp"
#include "motion/force/force_mode.hpp"
#include "motion/path/tcp_segment.hpp"
#include "motion/path_offset.hpp"
#include "state/controller_state.hpp"
#include "state/faults.hpp"

namespace ur_simulator {

struct RobotModel;

/// Identifies one motion since the controller started; never reused.
using MotionId = std::uint64_t;
/// The identifier of the started motion, or why the robot rejects it, worded as for the robot's log.
using StartResult = tl::expected<MotionId, std::string>;
/// Identifier of a motion that was skipped: its call returns at once.
constexpr MotionId skipped_motion_id = 0;

/// Options of movej and movel: acceleration (rad/s^2 of the leading joint, m/s^2), velocity (rad/s, m/s),
/// time (s, 0: determined by the velocity) and blend radius (m).
struct MoveOptions {
  double acceleration;
  double velocity;
  double time = 0.0;
  double blend_radius = 0.0;
};

/// Motion generator of the arm: executes one motion at a time, one control cycle at a time. A new motion
/// takes over from the current one at its position and velocity. Targets that are unreachable, not finite or
/// beyond limits are rejected; nothing throws. The arm moves only in robot mode RUNNING and safety mode
/// NORMAL, REDUCED or RECOVERY.
///
/// The state given to step() or teleport() must outlive the arm: its modes and its TCP offset apply to the
/// next motion. Cartesian motions use the TCP that was set when they started, until they end.
class Arm {
 public:
  Arm(const RobotModel & model, double cycle_time, const Vector6 & initial_position);
  ~Arm();
  Arm(const Arm &) = delete;
  Arm & operator=(const Arm &) = delete;

  // Motions to a target. With a blend radius the call may return when the TCP is inside that radius (movej,
  // movel, optimove*: at the earliest halfway). The motion that starts then is blended in; without one the
  // motion ends at its target. A motion whose blend would overlap with the previous one is skipped.
  StartResult move_joint(const Vector6 & target, const MoveOptions & options);
  StartResult move_linear(const Vector6 & tcp_pose, const MoveOptions & options);
  /// optimovej, optimovel: acceleration and velocity are fractions (0 < f <= 1) of the highest values on this
  /// path.
  StartResult move_joint_optimally(const Vector6 & target, const MoveOptions & options);
  StartResult move_linear_optimally(const Vector6 & tcp_pose, const MoveOptions & options);
  /// movep: constant tool speed, also in the blends with another movep, which are circular arcs.
  StartResult move_process(const Vector6 & tcp_pose, const MoveOptions & options);
  /// movec: on the circle through the start (the current TCP, or the target of a motion in its blend), `via`
  /// and the target.
  StartResult move_circular(const Vector6 & via, const Vector6 & tcp_pose, CircleMode mode,
                            const MoveOptions & options);
  /// servoc: from the current velocity on the tangent circle to the target.
  StartResult servo_circular(const Vector6 & tcp_pose, const MoveOptions & options);
  /// servoj: the call lasts `time` s; `lookahead` 0.03..0.2 s, `gain` 100..2000. The arm follows the target
  /// until another motion starts, even when the time is up.
  StartResult servo_joint(const Vector6 & target, double time, double lookahead, double gain);
  /// speedj, speedl: without a following motion the arm decelerates after `time` s; 0: no time limit.
  StartResult speed_joint(const Vector6 & velocity, double acceleration, double time);
  /// `rotational_acceleration`, rad/s^2: by default the value of `acceleration`.
  StartResult speed_linear(const Vector6 & tcp_twist, double acceleration, double time,
                           std::optional<double> rotational_acceleration = {});
  StartResult stop_joint(double deceleration);
  StartResult stop_linear(double deceleration, std::optional<double> rotational_deceleration = {});

  /// force_mode(): superposes compliance on every motion of the program until end_force_mode() or
  /// end_program(). A further call changes the settings. Compliance is suspended while the arm stops.
  tl::expected<void, std::string> start_force_mode(const ForceModeSettings & settings);
  /// The arm decelerates along the compliant axes. A motion of the program ends at the current position (a
  /// movel is restarted by its operation).
  void end_force_mode();
  bool in_force_mode() const;
  /// Scaling 0..2 and damping 0..1; they apply until the program ends.
  void set_force_mode_scaling(double scaling);
  void set_force_mode_damping(double damping);
  double force_mode_scaling() const;
  double force_mode_damping() const;
  /// freedrive_mode(): the arm is guided by hand along and about the free axes of the feature (a pose in the
  /// base frame) until end_freedrive(), the end of the program or a stop. Motions of the program are rejected
  /// in the meantime.
  StartResult start_freedrive(const std::array<bool, 6> & free_axes, const Vector6 & feature);
  void end_freedrive();
  /// direct_torque(): N m for the next cycle, gravity compensated. The scales (0..1) are the shares of the
  /// friction that the controller compensates.
  StartResult direct_torque(const Vector6 & torque, const Vector6 & viscous_scale,
                            const Vector6 & coulomb_scale);
  /// path_offset_…(): superposed on every motion of the program while it is enabled, except in force mode.
  PathOffset & path_offset();
  /// The path of the program continues from the current position; a motion must be stopped afterwards.
  void disable_path_offset();
  /// The time of paths starts slowly now, if the arm is at rest.
  void begin_program();
  /// Ends force mode, freedrive and path offset and resets their settings, as the end of a program does.
  void end_program();

  /// True when the URScript call that started this motion may return: paths at the target or in the blend;
  /// stopj and stopl at standstill; servoj when its time is up; speedj and speedl when the time is up or,
  /// without a time, when the velocity is reached. Also true if the motion was replaced, canceled or stopped
  /// by the safety system.
  bool call_complete(MotionId motion) const;
  /// True while the motion is in the blend at its end and continues to its target.
  bool in_blend(MotionId motion) const;
  /// True if this is the last motion that completed, neither canceled nor stopped by the safety system. The
  /// joint position does not tell: force mode keeps the TCP away from the target along compliant axes.
  bool reached_target(MotionId motion) const;
  /// TCP poses at the start and the target of the active path; nothing if the arm follows no path.
  struct PathEndpoints {
    Vector6 start;
    Vector6 target;
  };
  std::optional<PathEndpoints> path_endpoints() const;
  /// True while the arm executes this motion. A servoj or speedj may be active after its call returned.
  bool active(MotionId motion) const;
  /// Decelerates this motion along its path to standstill: its program ended or its thread was killed.
  void cancel(MotionId motion);
  /// Decelerates any motion along its path to standstill.
  void cancel_all();
  /// Stops any motion at `deceleration` (rad/s^2 of the fastest joint) and discards it, as a protective stop
  /// does.
  void stop_all(double deceleration);
  /// True if no motion is active, the target stands still, and the actual joints are not faster than
  /// `tolerance` (rad/s).
  bool at_rest(double tolerance = 1e-6) const;

  /// Ramps the speed scaling down to 0 and keeps the motion; resume() ramps it up again. speedj and speedl
  /// end.
  void pause();
  void resume();

  /// Why the arm stopped a motion since the last call; pass it to Safety::trigger_protective_stop().
  std::optional<MotionFault> take_fault();

  /// Advances by one cycle. Writes the target and actual joint state (with torques and currents), the TCP
  /// poses and speeds, the tool acceleration and the speed scaling.
  void step(ControllerState & state);
  /// Places the arm at a position at rest, for test set-ups. Throws std::invalid_argument if the position is
  /// not finite or beyond the joint limits.
  void teleport(const Vector6 & position, ControllerState & state);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ur_simulator
