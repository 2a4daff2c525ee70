#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <optional>
#include <ur_ros_rtde/check_result.hpp>
#include <ur_ros_rtde/command.hpp>
#include <ur_ros_rtde/mode.hpp>
#include <ur_ros_rtde_msgs/action/move_l.hpp>
#include <ur_ros_rtde_robot/state/conversions.hpp>
#include <ur_ros_rtde_tutorials/action/insert_peg.hpp>
#include <utility>

namespace ur_ros_rtde_tutorials {

using ur_ros_rtde::Check;
using ur_ros_rtde::ErrorCode;
using ur_ros_rtde::ForceModeOptions;
using ur_ros_rtde::Mode;
using ur_ros_rtde::Outcome;
using ur_ros_rtde::Sample;
using ur_ros_rtde::StopReason;
using ur_ros_rtde::Vector3;
using ur_ros_rtde::Vector6;
using ur_ros_rtde_msgs::action::MoveL;
using std::chrono_literals::operator""ms;

namespace {
constexpr double acceleration = 0.5;   // m/s^2
constexpr double clearance = 0.02;     // m, above a hole whose frame is known
constexpr double found_depth = 0.001;  // m, below the surface: the peg is in the hole
constexpr double spare_time = 2.0;     // s, in addition to distance / speed

std::vector<double> to_vector(const Vector6 & values)
{
  return {values.begin(), values.end()};
}

/// Displacement of the TCP since `start`, in the frame that the TCP had there, in m.
Vector3 displacement(const Sample & start, const Sample & now)
{
  const Vector6 & from = start.actual_tcp_pose;
  const Vector6 & to = now.actual_tcp_pose;
  return ur_ros_rtde::rotate_back(ur_ros_rtde::rotation(from),
                                  {to[0] - from[0], to[1] - from[1], to[2] - from[2]});
}

template <typename... Args>
Outcome not_reached(fmt::format_string<Args...> text, Args &&... args)
{
  return Outcome::failure(ErrorCode::not_reached, fmt::format(text, std::forward<Args>(args)...));
}

/// Archimedes' spiral r = pitch / 2 pi * angle, at constant speed.
struct Spiral {
  /// The velocity (m/s) after the next `time` (s).
  Vector3 advance(double time)
  {
    const double rate = speed / (pitch_per_rad * std::sqrt(1.0 + angle * angle));
    angle += rate * time;
    const double scale = pitch_per_rad * rate;
    return {scale * (std::cos(angle) - angle * std::sin(angle)),
            scale * (std::sin(angle) + angle * std::cos(angle)), 0.0};
  }
  double radius() const { return pitch_per_rad * angle; }

  double pitch_per_rad;  // m
  double speed;          // m/s
  double angle = 0.0;    // rad
};
}  // namespace

class InsertPeg : public ur_ros_rtde::Command<action::InsertPeg> {
  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("force", goal.force, 2.0, 100.0, "N")
        .above_zero("distance", goal.distance, 0.2, "m")
        .in_range("radius", goal.radius, 0.001, 0.05, "m")
        .in_range("pitch", goal.pitch, 0.0005, 0.01, "m")
        .in_range("depth", goal.depth, 0.002, 0.2, "m")
        .in_range("speed", goal.speed, 0.001, 0.05, "m/s");
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    if (!goal.hole.empty()) {
      if (Outcome above = run.call<MoveL>("move_l", above_hole(goal)); !above) {
        return above;
      }
    }
    ur_ros_rtde::check_result(run.control()->zeroFtSensor(), "zero the force/torque sensor");
    if (auto stop_reason = run.sleep_for(20ms)) {  // until RTDE packages contain the zeroed force
      return *stop_reason;
    }
    if (Outcome touched = find_surface(goal, run); !touched) {
      return touched;
    }
    const Sample surface = run.state();
    ForceModeOptions options{.task_frame = to_vector(surface.actual_tcp_pose),
                             .compliant = {false, false, true, false, false, false},
                             .wrench = {0.0, 0.0, goal.force, 0.0, 0.0, 0.0},
                             .limits = {0.1, 0.1, goal.speed, 0.5, 0.5, 0.5}};
    // The motion and force mode end with the goal, for any outcome.
    const Mode pressing = ur_ros_rtde::start_force_mode(run, options);
    if (Outcome found = search(goal, run, surface); !found) {
      return found;
    }
    options.compliant = {true, true, true, false, false, false};  // the peg follows the hole
    options.limits = {goal.speed, goal.speed, goal.speed, 0.5, 0.5, 0.5};
    ur_ros_rtde::start_force_mode(run, options).keep_on();  // `pressing` ends it
    return insert(goal, run, surface);
  }

  /// The tool's Z axis points into the hole.
  static MoveL::Goal above_hole(const Goal & goal)
  {
    MoveL::Goal above;
    above.frame_id = goal.hole;
    above.pose.position.z = clearance;
    above.pose.orientation.x = 1.0;
    above.pose.orientation.w = 0.0;
    return above;
  }

  /// Moves the TCP with a velocity (m/s) in the frame that it had at `start`, until the next call.
  static void move(Run & run, const Sample & start, const Vector3 & velocity)
  {
    const Vector3 v = ur_ros_rtde::rotate(ur_ros_rtde::rotation(start.actual_tcp_pose), velocity);
    // With a time: speedl takes the next velocity before it has reached this one.
    run.control()->speedL({v[0], v[1], v[2], 0.0, 0.0, 0.0}, acceleration, run.robot().cycle_time());
  }

  static Outcome find_surface(const Goal & goal, Run & run)
  {
    const Sample start = run.state();
    move(run, start, {0.0, 0.0, goal.speed});
    for (Sample now = start; -run.flange_force()[2] < 0.5 * goal.force;) {
      if (auto stop_reason = run.next(now)) {
        return *stop_reason;
      }
      if (displacement(start, now)[2] > goal.distance ||
          now.controller_time - start.controller_time > goal.distance / goal.speed + spare_time) {
        return not_reached("no surface within {} m along the tool's Z axis", goal.distance);
      }
    }
    move(run, start, {});
    const auto stop_reason = run.until_standstill();
    return stop_reason ? Outcome(*stop_reason) : Outcome::success();
  }

  /// Waits for the next package, and publishes the depth in it.
  static std::optional<StopReason> next(const Goal & goal, Run & run, const Sample & surface, Sample & now)
  {
    auto stop_reason = run.next(now);
    run.feedback().depth = displacement(surface, now)[2];
    run.progress(std::clamp(run.feedback().depth / goal.depth, 0.0, 1.0));
    return stop_reason;
  }

  /// Moves on a spiral until the peg is below the surface. Force mode goes on moving it along Z.
  static Outcome search(const Goal & goal, Run & run, const Sample & surface)
  {
    Spiral spiral{goal.pitch / (2.0 * std::numbers::pi), goal.speed};
    double last = surface.controller_time;
    for (Sample now = surface; run.feedback().depth < found_depth; last = now.controller_time) {
      if (auto stop_reason = next(goal, run, surface, now)) {
        return *stop_reason;
      }
      if (spiral.radius() > goal.radius) {
        return not_reached("no hole within {} m: start closer to it, or increase radius", goal.radius);
      }
      move(run, surface, spiral.advance(now.controller_time - last));
    }
    ur_ros_rtde::check_result(run.control()->speedStop(acceleration), "stop the search");
    return Outcome::success();
  }

  /// Waits until the peg is deep enough.
  static Outcome insert(const Goal & goal, Run & run, const Sample & surface)
  {
    Sample now = run.state();
    const double found = now.controller_time;
    while (run.feedback().depth < goal.depth) {
      if (auto stop_reason = next(goal, run, surface, now)) {
        return *stop_reason;
      }
      if (now.controller_time - found > goal.depth / goal.speed + spare_time) {
        return not_reached("the peg is {:.4f} m deep, not {} m: it is jammed, or the hole ends",
                           run.feedback().depth, goal.depth);
      }
    }
    const Vector3 moved = displacement(surface, now);
    run.result().offset = std::hypot(moved[0], moved[1]);
    return Outcome::success(fmt::format("{:.4f} m from the start of the search", run.result().offset));
  }
};

UR_ROS_RTDE_EXPORT(InsertPeg, "insert_peg")

}  // namespace ur_ros_rtde_tutorials
