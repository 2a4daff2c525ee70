#include <algorithm>
#include <ur_ros_rtde_msgs/action/speed_l.hpp>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class SpeedL : public Command<ur_ros_rtde_msgs::action::SpeedL> {
  void check(const Goal & goal, Check & check) const override
  {
    check.twist("twist", goal.twist)
        .above_zero("acceleration", goal.acceleration, 150.0, "m/s^2")
        .in_range("time", goal.time, 0.01, 3600.0, "s")
        .in_range("deceleration", goal.deceleration, 0.1, 150.0, "m/s^2");
  }

  StopOptions stop_options(const Goal & goal) const override
  {
    StopOptions options;
    options.linear_deceleration = goal.deceleration;
    return options;
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.control()->speedL(to_ur(goal.twist), goal.acceleration, 0.0);
    const double begin = run.state().controller_time;
    const auto time_is_over = [&] {
      run.progress(std::clamp((run.state().controller_time - begin) / goal.time, 0.0, 1.0));
      return run.progress() >= 1.0;
    };
    if (auto why = run.until(time_is_over, std::chrono::duration_cast<std::chrono::nanoseconds>(
                                               std::chrono::duration<double>(goal.time + 5.0)))) {
      return *why;
    }
    run.control()->speedStop(goal.deceleration);
    const auto why = run.until_standstill();
    return why ? Outcome(*why) : Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(SpeedL, "speed_l")

}  // namespace ur_ros_rtde
