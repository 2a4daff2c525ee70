#include <chrono>
#include <ur_ros_rtde_msgs/action/stop.hpp>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class Stop : public Command<ur_ros_rtde_msgs::action::Stop> {
  bool takes_over() const override { return true; }

  StopOptions stop_options(const Goal & goal) const override
  {
    StopOptions options;
    options.joint_deceleration = goal.joint_deceleration;
    options.linear_deceleration = goal.linear_deceleration;
    return options;
  }

  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("joint_deceleration", goal.joint_deceleration, 0.1, 40.0, "rad/s^2")
        .in_range("linear_deceleration", goal.linear_deceleration, 0.1, 150.0, "m/s^2");
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const auto report = run.robot().stop_motion(stop_options(goal));
    if (!report) {
      return report.error();
    }
    run.result().time_to_standstill = std::chrono::duration<double>(run.elapsed()).count();
    return Outcome::success(run.displaced().empty() ? to_string(report->means)
                                                    : run.displaced() + " was stopped");
  }
};

UR_ROS_RTDE_EXPORT(Stop, "stop")

}  // namespace ur_ros_rtde
