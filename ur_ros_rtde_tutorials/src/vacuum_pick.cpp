#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <ur_ros_rtde/command.hpp>
#include <ur_ros_rtde/digital_output.hpp>
#include <ur_ros_rtde/supervision.hpp>
#include <ur_ros_rtde_msgs/action/move_l_relative.hpp>
#include <ur_ros_rtde_msgs/action/move_until_force.hpp>
#include <ur_ros_rtde_robot/state/conversions.hpp>
#include <ur_ros_rtde_tutorials/action/vacuum_pick.hpp>

namespace ur_ros_rtde_tutorials {

using ur_ros_rtde::Check;
using ur_ros_rtde::CommandHost;
using ur_ros_rtde::Error;
using ur_ros_rtde::ErrorCode;
using ur_ros_rtde::Outcome;
using ur_ros_rtde::Sample;
using ur_ros_rtde::StopOptions;
using ur_ros_rtde::Supervision;
using ur_ros_rtde::Vector3;
using ur_ros_rtde::WhileReasonPersists;
using ur_ros_rtde_msgs::action::MoveLRelative;
using ur_ros_rtde_msgs::action::MoveUntilForce;
using std::chrono_literals::operator""s;

namespace {

bool bit(std::uint64_t bits, unsigned number)
{
  return ((bits >> number) & 1U) != 0;
}

/// A read-only parameter: the number of a digital input or output.
unsigned declare_number(CommandHost & host, const std::string & name, const std::string & description)
{
  rcl_cxx::ParameterDescriptor descriptor;
  descriptor.description = description;
  descriptor.read_only = true;
  descriptor.integer_range = {0, ur_ros_rtde::digital_output_count - 1};
  return static_cast<unsigned>(host.node().declare_parameter<std::int64_t>(name, 0, descriptor));
}

/// Down along the tool's Z axis until the force is reached.
MoveUntilForce::Goal approach(const action::VacuumPick::Goal & goal, const Sample & start)
{
  const Vector3 v = ur_ros_rtde::rotate(ur_ros_rtde::rotation(start.actual_tcp_pose), {0.0, 0.0, goal.speed});
  MoveUntilForce::Goal down;
  down.twist.linear.x = v[0];
  down.twist.linear.y = v[1];
  down.twist.linear.z = v[2];
  down.distance = goal.distance;
  down.axes = {false, false, true};
  down.threshold = goal.force;
  constexpr double reserve = 10.0;  // s
  down.timeout = goal.distance / goal.speed + reserve;
  return down;
}

MoveLRelative::Goal lift(const action::VacuumPick::Goal & goal)
{
  constexpr double factor = 5.0;
  MoveLRelative::Goal up;
  up.frame = MoveLRelative::Goal::TOOL;
  up.translation.z = -goal.lift;
  up.speed = factor * goal.speed;
  return up;
}

}  // namespace

class VacuumPick : public ur_ros_rtde::Command<action::VacuumPick> {
 public:
  void on_load(CommandHost & host) override
  {
    output_ = declare_number(host, "vacuum_pick.output", "Digital output that switches the vacuum on");
    input_ = declare_number(host, "vacuum_pick.input", "Digital input of the vacuum switch");
    host_ = &host;
  }
  void on_unload() override { supervision_.reset(); }

 private:
  void check(const Goal & goal, Check & check) const override
  {
    check.above_zero("distance", goal.distance, 0.2, "m")
        .in_range("force", goal.force, 2.0, 50.0, "N")
        .in_range("lift", goal.lift, 0.0, 0.5, "m")
        .in_range("speed", goal.speed, 0.001, 0.05, "m/s");
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    if (Outcome touched = run.call<MoveUntilForce>("move_until_force", approach(goal, run.state()));
        !touched) {
      return touched;
    }
    if (Outcome held = hold(run); !held) {
      return release(run, held);
    }
    supervise();
    return goal.lift > 0.0 ? run.call<MoveLRelative>("move_l_relative", lift(goal)) : Outcome::success();
  }

  Outcome hold(Run & run) const
  {
    if (Outcome on = ur_ros_rtde::set_digital_output(run, output_, true); !on) {
      return on;
    }
    const auto is_held = [&] { return bit(run.state().digital_inputs, input_); };
    return run.expect(is_held, 2s, "no vacuum within 2 s: there is no part", ErrorCode::not_reached);
  }

  /// Returns `why`, with a warning if the vacuum may still be on. A goal that has to end does not wait until
  /// the robot reports the output.
  Outcome release(Run & run, const Outcome & why) const
  {
    const Outcome off = ur_ros_rtde::set_digital_output(run, output_, false);
    return off || off.code() == why.code()
               ? why
               : Outcome::failure(why.code(), fmt::format("{}; the vacuum may still be on: {}", why.message(),
                                                          off.message()));
  }

  /// Stops the arm when the part is lost, until it is put down by switching the vacuum off.
  void supervise()
  {
    const auto lost = [this, is_held = true](const Sample & sample) mutable -> std::optional<Error> {
      is_held = is_held && bit(sample.digital_outputs, output_);
      if (!is_held || bit(sample.digital_inputs, input_)) {
        return std::nullopt;
      }
      return Error{ErrorCode::not_reached, "the part was lost: the vacuum switch is off"};
    };
    supervision_.emplace(*host_, StopOptions{}, WhileReasonPersists::allow, lost);
  }

  unsigned output_ = 0;
  unsigned input_ = 0;
  CommandHost * host_ = nullptr;
  std::optional<Supervision> supervision_;  // since the last pick; uses what is above
};

UR_ROS_RTDE_EXPORT(VacuumPick, "vacuum_pick")

}  // namespace ur_ros_rtde_tutorials
