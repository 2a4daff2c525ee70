#include <ur_ros_rtde_msgs/action/trigger.hpp>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class TriggerProtectiveStop : public Command<ur_ros_rtde_msgs::action::Trigger> {
  /// Allowed during every motion.
  CommandTraits traits() const override { return {.resource = Resource::none, .stops_arm = true}; }

  Outcome run(const Goal &, Run & run) override
  {
    // A secondary program runs in parallel to the control program and to scripts.
    ScriptOptions options;
    options.kind = ScriptKind::secondary;
    options.timeout = std::chrono::seconds(1);
    const ScriptReport report = run.run_script("protective_stop()", options);
    const auto stopped = [&] { return run.state().safety().protective_stopped; };
    return run.expect(stopped, std::chrono::seconds(1),
                      "the robot has not entered a protective stop; " + report.error.message);
  }
};

UR_ROS_RTDE_EXPORT(TriggerProtectiveStop, "trigger_protective_stop")

}  // namespace ur_ros_rtde
