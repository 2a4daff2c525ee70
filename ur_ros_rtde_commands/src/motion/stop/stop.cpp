#include <ur_ros_rtde_msgs/action/stop.hpp>

#include "motion/stop/decelerate.hpp"

namespace ur_ros_rtde {

class Stop : public Command<ur_ros_rtde_msgs::action::Stop> {
  CommandTraits traits() const override { return {.preempts_all = true}; }

  StopOptions stop_options(const Goal & goal) const override
  {
    StopOptions options;
    options.joint_deceleration = goal.joint_deceleration;
    options.linear_deceleration = goal.linear_deceleration;
    return options;
  }

  void check(const Goal & goal, Check & check) const override
  {
    check
        .in_range("joint_deceleration", goal.joint_deceleration, min_deceleration, max_joint_deceleration,
                  "rad/s^2")
        .in_range("linear_deceleration", goal.linear_deceleration, min_deceleration, max_linear_deceleration,
                  "m/s^2");
  }

  Outcome run(const Goal &, Run & run) override { return wait_until_stopped(run); }
};

UR_ROS_RTDE_EXPORT(Stop, "stop")

}  // namespace ur_ros_rtde
