#include <fmt/format.h>

#include <cmath>
#include <ur_ros_rtde/command.hpp>
#include <ur_ros_rtde_gripper_commands/action/robotiq_activate.hpp>
#include <ur_ros_rtde_gripper_commands/action/robotiq_get_status.hpp>
#include <ur_ros_rtde_gripper_commands/action/robotiq_grip.hpp>
#include <ur_ros_rtde_gripper_commands/action/robotiq_move.hpp>

#include "robotiq/robotiq_gripper.hpp"

namespace ur_ros_rtde_gripper_commands {
namespace {

using ur_ros_rtde::Check;
using ur_ros_rtde::Command;
using ur_ros_rtde::CommandTraits;
using ur_ros_rtde::Outcome;
using ur_ros_rtde::Resource;

constexpr double max_stroke = 0.2;      // m
constexpr double min_stroke = 0.01;     // m
constexpr double longest_timeout = 60;  // s

/// Goals of a robot without the URCap are rejected. Placed last: it waits for the robot.
void check_urcap(Check & check)
{
  check.query([](ur_ros_rtde::Robot & robot) -> ur_ros_rtde::Status {
    const auto client = RobotiqClient::connect(robot.address());
    return client ? ur_ros_rtde::Status() : tl::unexpected(client.error());
  });
}

template <typename Goal>
FingerRange range_of(const Goal & goal)
{
  return {goal.stroke, goal.closed_position};
}

template <typename Goal>
void check_range(Check & check, const Goal & goal)
{
  check.in_range("stroke", goal.stroke, min_stroke, max_stroke, "m")
      .in_range("closed_position", goal.closed_position, 1, max_register);
}

template <typename Goal>
void check_motion(Check & check, const Goal & goal)
{
  check_range(check, goal);
  check.in_range("speed_fraction", goal.speed_fraction, 0.0, 1.0)
      .in_range("force_fraction", goal.force_fraction, 0.0, 1.0)
      .above_zero("timeout", goal.timeout, longest_timeout, "s");
}

template <typename Goal>
RobotiqTarget make_target(const Goal & goal, int position)
{
  const auto to_register = [](double fraction) {
    return static_cast<int>(std::lround(fraction * max_register));
  };
  return {position, to_register(goal.speed_fraction), to_register(goal.force_fraction)};
}

/// Moves the fingers and fills in the result and the feedback of a motion.
template <typename Goal, typename Run>
Outcome move_fingers(const Goal & goal, Run & run, int position)
{
  RobotiqGripper gripper(run, goal.timeout, [&](const RobotiqState & state) {
    run.result().position = static_cast<std::uint8_t>(state.position);
    run.result().width = range_of(goal).width(state.position);
    run.result().object_detected = state.object_detected();
    run.feedback().width = run.result().width;
    run.publish();
  });
  return gripper.move(make_target(goal, position));
}

}  // namespace

/// The gripper may move together with the arm, but only for one goal at a time.
template <typename A>
class RobotiqCommand : public Command<A> {
  CommandTraits traits() const override { return {.resource = Resource::io}; }
};

class RobotiqActivate : public RobotiqCommand<action::RobotiqActivate> {
  void check(const Goal & goal, Check & check) const override
  {
    check.above_zero("timeout", goal.timeout, longest_timeout, "s");
    check_urcap(check);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    RobotiqGripper gripper(run, goal.timeout, [&run](const RobotiqState & state) {
      run.feedback().position = static_cast<std::uint8_t>(state.position);
      run.publish();
    });
    return gripper.activate(goal.reset);
  }
};

UR_ROS_RTDE_EXPORT(RobotiqActivate, "robotiq_activate")

class RobotiqMove : public RobotiqCommand<action::RobotiqMove> {
  void check(const Goal & goal, Check & check) const override
  {
    check_motion(check, goal);
    check.in_range("width", goal.width, 0.0, goal.stroke, "m");
    check_urcap(check);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    return move_fingers(goal, run, range_of(goal).position(goal.width));
  }
};

UR_ROS_RTDE_EXPORT(RobotiqMove, "robotiq_move")

class RobotiqGrip : public RobotiqCommand<action::RobotiqGrip> {
 public:
  explicit RobotiqGrip(int position) : position_(position) {}

 private:
  void check(const Goal & goal, Check & check) const override
  {
    check_motion(check, goal);
    check_urcap(check);
  }

  Outcome run(const Goal & goal, Run & run) override { return move_fingers(goal, run, position_); }

  const int position_;
};

class RobotiqOpen : public RobotiqGrip {
 public:
  RobotiqOpen() : RobotiqGrip(0) {}
};

UR_ROS_RTDE_EXPORT(RobotiqOpen, "robotiq_open")

class RobotiqClose : public RobotiqGrip {
 public:
  RobotiqClose() : RobotiqGrip(max_register) {}
};

UR_ROS_RTDE_EXPORT(RobotiqClose, "robotiq_close")

class RobotiqGetStatus : public Command<action::RobotiqGetStatus> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }

  void check(const Goal & goal, Check & check) const override
  {
    check_range(check, goal);
    check_urcap(check);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const RobotiqState state = RobotiqGripper(run, longest_timeout, {}).read();
    run.result().active = state.active();
    run.result().position = static_cast<std::uint8_t>(state.position);
    run.result().width = range_of(goal).width(state.position);
    run.result().object_detected = state.object_detected();
    run.result().fault = static_cast<std::uint8_t>(state.fault);
    run.result().fault_text = robotiq_fault_text(state.fault);
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(RobotiqGetStatus, "robotiq_get_status")

}  // namespace ur_ros_rtde_gripper_commands
