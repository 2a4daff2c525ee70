#include <ur_ros_rtde_msgs/action/trigger.hpp>

#include "force/compliance.hpp"

namespace ur_ros_rtde {

class ForceModeStop : public Command<ur_ros_rtde_msgs::action::Trigger> {
  CommandTraits traits() const override { return {.leaves_mode_active = true}; }

  Outcome run(const Goal &, Run & run) override
  {
    must_do(run.control()->forceModeStop(), "end force mode");
    const auto why = run.until_standstill();
    return why ? Outcome(*why) : Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(ForceModeStop, "force_mode_stop")

}  // namespace ur_ros_rtde
