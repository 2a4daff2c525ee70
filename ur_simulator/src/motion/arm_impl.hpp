#pragma once

#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "kinematics/inverse_kinematics.hpp"
#include "motion/argument_checks.hpp"
#include "motion/arm.hpp"
#include "motion/arm_state_writer.hpp"
#include "motion/force/force_mode.hpp"
#include "motion/force/forward_dynamics.hpp"
#include "motion/force/freedrive_motion.hpp"
#include "motion/force/torque_motion.hpp"
#include "motion/joint_servo_loop.hpp"
#include "motion/path/path_motion.hpp"
#include "motion/path_offset.hpp"
#include "motion/servo/joint_servo_motion.hpp"
#include "motion/servo/joint_speed_motion.hpp"
#include "motion/servo/linear_speed_motion.hpp"
#include "motion/tcp_kinematics.hpp"

namespace ur_simulator {

class PathPlanner;

constexpr double fault_deceleration = 20.0;  ///< rad/s^2
constexpr double lapse_speed = 0.02;         ///< rad/s, from which on the arm counts as moving
constexpr double default_force_scaling = 1.0;
constexpr double default_force_damping = 0.005;  ///< script manual, "force_mode_set_damping"

/// Any motion, stored in place: motions start inside the control cycle, which does not allocate.
using AnyMotion = std::variant<std::monostate, PathMotion, JointServoMotion, JointSpeedMotion,
                               LinearSpeedMotion, FreedriveMotion, TorqueMotion>;

/// Null if there is none.
inline Motion * get_motion(AnyMotion & active_motion)
{
  return std::visit(
      [](auto & held) -> Motion * {
        if constexpr (std::is_base_of_v<Motion, std::decay_t<decltype(held)>>) {
          return &held;
        } else {
          return nullptr;
        }
      },
      active_motion);
}

/// Implementation of Arm, shared by the arm*.cpp files.
struct Arm::Impl {
  Impl(const RobotModel & robot_model, double cycle, const Vector6 & position)
      : model(robot_model),
        cycle_time(cycle),
        servo_loop(robot_model.series, cycle, position),
        writer(robot_model, cycle),
        dynamics(robot_model)
  {
    setpoint.position = position;
    commanded = setpoint;
  }

  const RobotModel & model;
  double cycle_time;
  Setpoint setpoint;
  JointServoLoop servo_loop;
  ArmStateWriter writer;
  AnyMotion active_motion;
  MotionId last_id = 0;                          ///< of the active motion; the highest in use
  MotionId last_reached_id = skipped_motion_id;  ///< of the last motion that completed
  bool canceled = false;                         ///< the active motion only decelerates
  bool is_ended_by_program = false;              ///< the active motion: its thread has ended
  bool has_lapse = false;                        ///< the active motion is counted in `lapses`
  MotionLapses lapses;
  bool is_stop = false;  ///< the active motion is a stop: leaving its path is no fault
  bool paused = false;
  double start_scaling = 1.0;               ///< of paths, grows from 0 to 1 after the start of a program
  const ControllerState * state = nullptr;  ///< of the last step: modes and TCP for the next motion
  std::optional<MotionFault> fault;

  std::optional<ForceMode> force;
  double force_scaling = default_force_scaling;
  double force_damping = default_force_damping;
  PathOffset path_offset;
  Setpoint
      commanded;  ///< target of the servo loops: the setpoint plus the deviation of force mode or path offset
  ForwardDynamics dynamics;

  Motion * current_motion() { return get_motion(active_motion); }

  bool may_move() const
  {
    return state != nullptr && state->robot_mode == RobotMode::running && allows_motion(state->safety_mode);
  }

  Rejection check_ready(std::string_view function) const
  {
    if (in_freedrive()) {
      return fmt::format("{}: the arm is in freedrive: call end_freedrive_mode() first", function);
    }
    if (may_move()) {
      return std::nullopt;
    }
    if (state == nullptr) {
      return fmt::format("{}: the robot has not started yet", function);
    }
    return fmt::format("{}: the robot cannot move: its mode is {}, its safety mode {}", function,
                       to_string(state->robot_mode), to_string(state->safety_mode));
  }

  Rejection check_reachable(std::string_view function, const Vector6 & tcp_pose) const
  {
    const auto solution = get_inverse_kin(model, tcp_pose, setpoint.position, state->tcp_offset);
    return solution ? std::nullopt : Rejection(fmt::format("{}: {}", function, solution.error()));
  }

  template <typename M>
  MotionId start_motion(M && motion, bool stop = false)
  {
    active_motion = std::forward<M>(motion);
    canceled = is_ended_by_program = has_lapse = false;
    is_stop = stop;
    return ++last_id;
  }

  /// True while the arm is guided by hand.
  bool in_freedrive() const { return std::holds_alternative<FreedriveMotion>(active_motion) && !canceled; }
  /// True while a stop replaces the motion that the program requested.
  bool stopping() const
  {
    return is_stop && canceled && !std::holds_alternative<std::monostate>(active_motion);
  }

  TcpKinematics tcp_kinematics() const { return {model, state->tcp_offset}; }

  Rejection check_cartesian_target(std::string_view function, const Vector6 & pose,
                                   const MoveOptions & options) const;
  /// A planner for the next path. `kinematics` and the active motion must outlive it.
  PathPlanner make_planner(const TcpKinematics & kinematics);
  /// Starts the path that `plan` makes with the planner.
  template <typename Plan>
  StartResult start_path(const Transform & target, double blend_radius, Plan plan);

  void ramp_speed_scaling(ControllerState & current);
  bool moves() const { return setpoint.velocity.cwiseAbs().maxCoeff() > lapse_speed; }
  /// Counts a motion of the running program that ends while the arm moves.
  void count_broken_motion(const ControllerState & current);
  /// The time that passes for the active motion in this cycle.
  TimeStep time_step(const ControllerState & current) const;
  void advance(const TimeStep & time_step);
  /// Replaces the active motion by a stop.
  void replace_with_stop(double deceleration);
  void command_joints(const TimeStep & time_step);
  void apply_force_mode(const TimeStep & time_step);
  void apply_path_offset(const TimeStep & time_step);
  /// Stops at the commanded position because of a fault of force mode or path offset.
  void stop_with_fault(const MotionFault & found, const TimeStep & time_step);
  void write_path(ControllerState & current);
  /// Moves the program's setpoint to the commanded position, so that force mode starts without deviation.
  void reset_deviation();
  /// Sets the setpoint to the actual joint state, for motions that control the actual joints.
  void start_from_actual_joints();
};

}  // namespace ur_simulator
