// Commands that call other commands.
#include <chrono>
#include <semaphore>
#include <stdexcept>
#include <ur_ros_rtde_msgs/action/move_j_relative.hpp>
#include <ur_ros_rtde_msgs/action/send_script.hpp>
#include <ur_ros_rtde_msgs/action/speed_j.hpp>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

using ur_ros_rtde_msgs::action::MoveJRelative;
using ur_ros_rtde_msgs::action::SendScript;
using ur_ros_rtde_msgs::action::SpeedJ;

/// Calls speed_j, for the stop property test. Is stopped as that.
class CallsSpeedJ : public Command<SpeedJ> {
  Outcome run(const Goal & goal, Run & run) override { return run.call<SpeedJ>("speed_j", goal); }
};

/// Calls the command that `script` names, with a goal of MoveJRelative, and then turns wrist 3 back. Its
/// outcome is that of the called command.
class CallsMoveJRelative : public Command<SendScript> {
  Outcome run(const Goal & goal, Run & run) override
  {
    MoveJRelative::Goal there;
    there.joint_offsets = {0.0, 0.0, 0.0, 0.0, 0.0, 0.2};
    there.speed = goal.timeout;  // above 3.14: rejected by its check
    MoveJRelative::Result result;
    const Outcome outcome = run.call<MoveJRelative>(goal.script, there, result);
    if (outcome) {
      run.result().output = {result.success ? "success" : "failure", result.message,
                             std::to_string(result.final_state.joint_positions[5])};
    }
    MoveJRelative::Goal back;
    back.joint_offsets = {0.0, 0.0, 0.0, 0.0, 0.0, -0.1};
    const Outcome moved_back = run.call<MoveJRelative>("move_j_relative", back);
    return outcome ? moved_back : outcome;
  }
};

/// Calls itself.
class CallsItself : public Command<SendScript> {
  Outcome run(const Goal & goal, Run & run) override { return run.call<SendScript>("calls_itself", goal); }
};

/// Calls a motion, and does not have the arm.
class CallsWithoutTheArm : public Command<SendScript> {
  CommandTraits traits() const override { return {.resource = Resource::io}; }
  Outcome run(const Goal &, Run & run) override
  {
    MoveJRelative::Goal goal;
    goal.joint_offsets = {0.0, 0.0, 0.0, 0.0, 0.0, 0.2};
    return run.call<MoveJRelative>("move_j_relative", goal);
  }
};

/// Calls starts_late before that has been started.
class CallsOneThatStartsLate : public Command<SendScript> {
 public:
  static std::binary_semaphore & has_called()
  {
    static std::binary_semaphore called{0};
    return called;
  }

 private:
  CommandTraits traits() const override { return {.resource = Resource::none}; }
  Outcome run(const Goal & goal, Run & run) override
  {
    has_called().release();
    return run.call<SendScript>("starts_late", goal);
  }
};

/// Its action server is not started before it has been called.
class StartsLate : public Command<SendScript> {
 public:
  void start_action_server(CommandHost & host, const std::string & name) override
  {
    if (!CallsOneThatStartsLate::has_called().try_acquire_for(std::chrono::seconds(20))) {
      throw std::runtime_error("nothing has called it");
    }
    Command::start_action_server(host, name);
  }

 private:
  CommandTraits traits() const override { return {.resource = Resource::none}; }
  Outcome run(const Goal &, Run &) override { return Outcome::success(); }
};

/// Turns joints for a time, and fails while they turn.
class LeavesTurning : public Command<SpeedJ> {
  StopOptions stop_options(const Goal & goal) const override
  {
    return {.joint_deceleration = goal.deceleration};
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.control()->speedJ({goal.joint_velocities.begin(), goal.joint_velocities.end()}, goal.acceleration,
                          0.0);
    constexpr std::chrono::milliseconds turning_time{300};
    if (auto why = run.sleep_for(turning_time)) {
      return *why;
    }
    return Outcome::failure(ErrorCode::not_reached, "left turning");
  }
};

/// Calls leaves_turning, and moves on after its failure.
class MovesOn : public Command<SpeedJ> {
  Outcome run(const Goal & goal, Run & run) override
  {
    const Outcome failed = run.call<SpeedJ>("leaves_turning", goal);
    MoveJRelative::Goal back;
    back.joint_offsets = {0.0, 0.0, 0.0, 0.0, 0.0, -0.1};
    const Outcome moved = run.call<MoveJRelative>("move_j_relative", back);
    return moved ? failed : moved;
  }
};

/// Turns joints without having the arm, and succeeds while they turn.
template <Resource resource>
class Turns : public Command<SpeedJ> {
  CommandTraits traits() const override { return {.resource = resource}; }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.control()->speedJ({goal.joint_velocities.begin(), goal.joint_velocities.end()}, goal.acceleration,
                          0.0);
    return Outcome::success();
  }
};

/// Starts to move the tool at a velocity, and succeeds before it moves.
class StartsSpeedL : public Command<SpeedJ> {
  Outcome run(const Goal & goal, Run & run) override
  {
    run.control()->speedL({0.0, 0.0, 0.05, 0.0, 0.0, 0.0}, goal.acceleration, 0.0);
    return Outcome::success();
  }
};

/// Starts to push the tool along the Z axis, and succeeds before it moves.
class StartsForceMode : public Command<SpeedJ> {
  Outcome run(const Goal &, Run & run) override
  {
    run.control()->forceMode({0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, {0, 0, 1, 0, 0, 0},
                             {0.0, 0.0, 10.0, 0.0, 0.0, 0.0}, 2, {0.1, 0.1, 0.05, 0.5, 0.5, 0.5});
    return Outcome::success();
  }
};

using TurnsAsMode = Turns<Resource::mode>;
using TurnsAsOutput = Turns<Resource::io>;

UR_ROS_RTDE_EXPORT(CallsSpeedJ, "calls_speed_j")
UR_ROS_RTDE_EXPORT(CallsMoveJRelative, "calls_move_j_relative")
UR_ROS_RTDE_EXPORT(CallsItself, "calls_itself")
UR_ROS_RTDE_EXPORT(CallsWithoutTheArm, "calls_without_the_arm")
UR_ROS_RTDE_EXPORT(CallsOneThatStartsLate, "calls_one_that_starts_late")
UR_ROS_RTDE_EXPORT(StartsLate, "starts_late")
UR_ROS_RTDE_EXPORT(LeavesTurning, "leaves_turning")
UR_ROS_RTDE_EXPORT(MovesOn, "moves_on")
UR_ROS_RTDE_EXPORT(StartsSpeedL, "starts_speed_l")
UR_ROS_RTDE_EXPORT(StartsForceMode, "starts_force_mode")
UR_ROS_RTDE_EXPORT(TurnsAsMode, "turns_as_mode")
UR_ROS_RTDE_EXPORT(TurnsAsOutput, "turns_as_output")

}  // namespace ur_ros_rtde
