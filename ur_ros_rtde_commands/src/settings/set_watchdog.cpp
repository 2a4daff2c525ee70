#include <ur_ros_rtde_msgs/action/set_watchdog.hpp>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class SetWatchdog : public Command<ur_ros_rtde_msgs::action::SetWatchdog> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }

  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("min_frequency", goal.min_frequency, min_watchdog_frequency, max_watchdog_frequency, "Hz")
        .answers_queries();
  }

  Outcome run(const Goal & goal, Run & run) override { return run.set_watchdog(goal.min_frequency); }
};

UR_ROS_RTDE_EXPORT(SetWatchdog, "set_watchdog")

}  // namespace ur_ros_rtde
