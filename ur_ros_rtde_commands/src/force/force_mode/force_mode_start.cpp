#include "force/force_mode/force_mode_helpers.hpp"

namespace ur_ros_rtde {

class ForceModeStart : public Command<ur_ros_rtde_msgs::action::ForceMode> {
  /// Force mode can be changed while another goal moves the arm.
  CommandTraits traits() const override { return {.resource = Resource::mode, .leaves_mode_active = true}; }

  void check(const Goal & goal, Check & check) const override
  {
    check_force_mode(goal, false, check);
    check.answers_queries();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    start_force_mode(run, goal).keep_on();
    return Outcome::success("force mode is on until force_mode_stop, stop, or a motion that fails");
  }
};

UR_ROS_RTDE_EXPORT(ForceModeStart, "force_mode_start")

}  // namespace ur_ros_rtde
