#include <ur_ros_rtde_msgs/action/jog.hpp>

#include "motion/velocity/velocity.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double unlimited_time = 365.0 * 24.0 * 3600.0;  // s
}

class Jog : public Command<ur_ros_rtde_msgs::action::Jog> {
  void check(const Goal & goal, Check & check) const override
  {
    check.twist("twist", goal.twist)
        .in_range("frame", goal.frame, Goal::BASE, Goal::CUSTOM)
        .frame("custom_frame", goal.custom_frame)
        .above_zero("acceleration", goal.acceleration, 150.0, "m/s^2")
        .in_range("time", goal.time, 0.0, 3600.0, "s");
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.control()->jogStart(to_ur(goal.twist), goal.frame, goal.acceleration, to_ur(goal.custom_frame));
    const auto stop_reason = wait_with_progress(run, goal.time == 0.0 ? unlimited_time : goal.time);
    if (stop_reason && stop_reason->code != ErrorCode::canceled) {  // a cancel is the regular end of jogging
      return *stop_reason;
    }
    const auto stopped = run.robot().stop_motion();
    return stopped ? Outcome::success() : Outcome(stopped.error());
  }
};

UR_ROS_RTDE_EXPORT(Jog, "jog")

}  // namespace ur_ros_rtde
