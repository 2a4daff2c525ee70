#include <ur_ros_rtde_msgs/action/trigger.hpp>

#include "force/compliance.hpp"

namespace ur_ros_rtde {

class FreedriveStop : public Command<ur_ros_rtde_msgs::action::Trigger> {
  CommandTraits traits() const override { return {.leaves_mode_active = true}; }

  Outcome run(const Goal &, Run & run) override
  {
    must_do(run.control()->endFreedriveMode(), "end freedrive");
    const auto why = run.until_standstill();
    return why ? Outcome(*why) : Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(FreedriveStop, "freedrive_stop")

}  // namespace ur_ros_rtde
