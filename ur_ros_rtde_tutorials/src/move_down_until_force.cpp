#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ur_ros_rtde/check_result.hpp>
#include <ur_ros_rtde/command.hpp>
#include <ur_ros_rtde_tutorials/action/move_down_until_force.hpp>

namespace ur_ros_rtde_tutorials {

using ur_ros_rtde::Check;
using ur_ros_rtde::check_result;
using ur_ros_rtde::ErrorCode;
using ur_ros_rtde::Outcome;
using std::chrono_literals::operator""ms;

class MoveDownUntilForce : public ur_ros_rtde::Command<action::MoveDownUntilForce> {
  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("force", goal.force, 1.0, 500.0, "N")
        .above_zero("distance", goal.distance, 2.0, "m")
        .above_zero("speed", goal.speed, 1.0, "m/s")
        .above_zero("acceleration", goal.acceleration, 10.0, "m/s^2")
        .in_range("deceleration", goal.deceleration, 0.1, 40.0, "rad/s^2")
        .polyscope(0);  // a CB3 controller cannot zero the sensor
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    check_result(run.control()->zeroFtSensor(), "zero the sensor");
    if (auto stop_reason = run.sleep_for(20ms)) {  // until RTDE packages contain the zeroed force
      return *stop_reason;
    }
    auto goal_pose = run.receive()->getActualTCPPose();
    const double start = goal_pose[2];
    goal_pose[2] -= goal.distance;
    if (Outcome possible = run.check_again([&](Check & check) { check.reachable("distance", goal_pose); });
        !possible) {
      return possible;
    }
    run.control()->moveL(goal_pose, goal.speed, goal.acceleration, true);
    while (true) {
      const double force = run.flange_force()[2];
      report(goal, run, force, start);
      if (!(std::abs(force) <= goal.force)) {  // true without a force, too
        run.control()->stopJ(goal.deceleration, true);
        break;
      }
      if (run.motion_ended()) {
        return end_of_motion(goal, run);
      }
      if (auto stop_reason = run.sleep_for(2ms)) {
        return *stop_reason;
      }
    }
    return wait_for_standstill(goal, run, start);
  }

  /// Publishes the feedback and stores the same values in the result.
  static void report(const Goal & goal, Run & run, double force, double start)
  {
    const double distance = start - run.state().actual_tcp_pose[2];
    run.feedback().force = run.result().force = force;
    run.feedback().distance = run.result().distance = distance;
    run.progress(std::clamp(distance / goal.distance, 0.0, 1.0));
  }

  static Outcome end_of_motion(const Goal & goal, Run & run)
  {
    if (Outcome ended = run.until_motion_ends(); !ended) {
      return ended;  // the motion failed, or never started
    }
    return Outcome::failure(ErrorCode::not_reached, fmt::format("no force above {} N within {} m downwards",
                                                                goal.force, goal.distance));
  }

  static Outcome wait_for_standstill(const Goal & goal, Run & run, double start)
  {
    const double force = run.result().force;
    const double stop = run.state().controller_time;
    if (auto stop_reason = run.until_standstill()) {
      return *stop_reason;
    }
    report(goal, run, force, start);
    run.result().stopping_time = run.state().controller_time - stop;
    return Outcome::success(
        fmt::format("stopped by {:.1f} N along the flange's Z axis, {:.3f} m further down", force,
                    run.result().distance));
  }
};

UR_ROS_RTDE_EXPORT(MoveDownUntilForce, "move_down_until_force")

}  // namespace ur_ros_rtde_tutorials
