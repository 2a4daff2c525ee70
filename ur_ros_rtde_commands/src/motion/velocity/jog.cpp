#include <ur_ros_rtde_msgs/action/jog.hpp>

#include "motion/speed_limits.hpp"
#include "ur_ros_rtde/command.hpp"
#include "wait_for_duration.hpp"

namespace ur_ros_rtde {

class Jog : public Command<ur_ros_rtde_msgs::action::Jog> {
  void check(const Goal & goal, Check & check) const override
  {
    check.twist("twist", goal.twist)
        .in_range("frame", goal.frame, Goal::BASE, Goal::CUSTOM)
        .frame("custom_frame", goal.custom_frame)
        .above_zero("acceleration", goal.acceleration, linear_speed_limits.acceleration,
                    linear_speed_limits.acceleration_unit)
        .in_range("time", goal.time, 0.0, 3600.0, "s");
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.control()->jogStart(to_ur(goal.twist), goal.frame, goal.acceleration, to_ur(goal.custom_frame));
    const auto stop_reason = wait_for_duration(run, goal.time);
    // A cancel is the regular end of jogging.
    return stop_reason && stop_reason->code != ErrorCode::canceled ? Outcome(*stop_reason)
                                                                   : Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(Jog, "jog")

}  // namespace ur_ros_rtde
