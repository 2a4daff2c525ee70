#include <ur_ros_rtde_msgs/action/trigger.hpp>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class ReuploadScript : public Command<ur_ros_rtde_msgs::action::Trigger> {
  CommandTraits traits() const override { return {.resource = Resource::script}; }

  Outcome run(const Goal &, Run & run) override
  {
    // The driver uploads the control program again after every script that has replaced it.
    const ScriptReport report = run.run_script("sync()");
    if (!report) {
      return report.error;
    }
    return run.robot().ready_to_move();
  }
};

UR_ROS_RTDE_EXPORT(ReuploadScript, "reupload_script")

}  // namespace ur_ros_rtde
