#pragma once

#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "kinematics/inverse.hpp"
#include "motion/arm.hpp"
#include "motion/arm_state.hpp"
#include "motion/cartesian_path.hpp"
#include "motion/follower.hpp"
#include "motion/force_mode.hpp"
#include "motion/forward_dynamics.hpp"
#include "motion/freedrive.hpp"
#include "motion/joint_servo.hpp"
#include "motion/joint_speed.hpp"
#include "motion/linear_speed.hpp"
#include "motion/path_move.hpp"
#include "motion/refusal.hpp"
#include "motion/torque_control.hpp"

namespace ur_simulator {

class PathPlanner;

constexpr double fault_deceleration = 20.0;  ///< rad/s^2
constexpr double default_force_scaling = 1.0;
constexpr double default_force_damping = 0.025;

/// Room for any motion, in place: motions start within the control cycle, where nothing is allocated.
using MotionSlot =
    std::variant<std::monostate, PathMove, JointServo, JointSpeed, LinearSpeed, Freedrive, TorqueControl>;

inline Motion * motion_in(MotionSlot & slot)
{
  return std::visit(
      [](auto & held) -> Motion * {
        if constexpr (std::is_base_of_v<Motion, std::decay_t<decltype(held)>>) {
          return &held;
        } else {
          return nullptr;
        }
      },
      slot);
}

/// What the sources of the arm share; nobody else includes this.
struct Arm::Impl {
  Impl(const RobotModel & robot_model, double cycle, const Vector6 & position)
      : model(robot_model),
        cycle_time(cycle),
        follower(cycle, position),
        writer(robot_model, cycle),
        dynamics(robot_model)
  {
    setpoint.position = position;
    commanded = setpoint;
  }

  const RobotModel & model;
  double cycle_time;
  Setpoint setpoint;
  Follower follower;
  ArmStateWriter writer;
  MotionSlot slot;
  MotionId last_id = 0;                    // of the motion in the slot, and the highest given away
  MotionId last_arrived = skipped_motion;  // of the last motion that went all its way
  bool given_up = false;                   // the motion in the slot only brakes any more
  bool is_stop = false;                    // it is a stop: that it cannot go on straight is no fault
  bool paused = false;
  const ControllerState * state =
      nullptr;  // of the last step: its modes and its TCP hold for what starts next
  std::optional<MotionFault> fault;

  std::optional<ForceMode> force;
  double force_scaling = default_force_scaling;
  double force_damping = default_force_damping;
  Setpoint commanded;  // where the servo loops lead the joints: the setpoint, and what force mode adds
  ForwardDynamics dynamics;

  Motion * motion() { return motion_in(slot); }

  bool may_move() const
  {
    return state != nullptr && state->robot_mode == RobotMode::running && allows_motion(state->safety_mode);
  }

  Refusal not_ready(std::string_view call) const
  {
    if (guided()) {
      return fmt::format("{}: the arm is in freedrive: call end_freedrive_mode() first", call);
    }
    if (may_move()) {
      return std::nullopt;
    }
    if (state == nullptr) {
      return fmt::format("{}: the robot has not started yet", call);
    }
    return fmt::format("{}: the robot cannot move: its mode is {}, its safety mode {}", call,
                       to_string(state->robot_mode), to_string(state->safety_mode));
  }

  Refusal unreachable(std::string_view call, const Vector6 & tcp_pose) const
  {
    const auto solution = get_inverse_kin(model, tcp_pose, setpoint.position, state->tcp_offset);
    return solution ? std::nullopt : Refusal(fmt::format("{}: {}", call, solution.error()));
  }

  template <typename M>
  MotionId begin(M && motion, bool stop = false)
  {
    slot = std::forward<M>(motion);
    given_up = false;
    is_stop = stop;
    return ++last_id;
  }

  /// Do hands lead the arm?
  bool guided() const { return std::holds_alternative<Freedrive>(slot) && !given_up; }
  /// Does it only come to a stop, whatever was asked for?
  bool braking() const { return is_stop && given_up && !std::holds_alternative<std::monostate>(slot); }

  CartesianPath path() const { return {model, state->tcp_offset}; }

  Refusal no_cartesian(std::string_view call, const Vector6 & pose, const MoveOptions & options) const;
  /// Lays what starts next; `path` and the motion in the slot must stay as long as the planner.
  PathPlanner planner(const CartesianPath & path);
  /// `lay` makes the path out of the planner.
  template <typename Lay>
  MotionStart begin_path(const Transform & target, double blend_radius, Lay lay);

  void ramp_scaling(ControllerState & current) const;
  void advance(const Tick & tick);
  void brake_hard(double deceleration);
  void lead_joints(const Tick & tick);
  void comply(const Tick & tick);
  void drop_deviation();
  /// The setpoint is where the joints are: no servo loop leads them from here on.
  void take_over_joints();
};

}  // namespace ur_simulator
