#include <ur_ros_rtde_msgs/action/teach_mode.hpp>

#include "force/compliance.hpp"

namespace ur_ros_rtde {

class TeachModeStart : public Command<ur_ros_rtde_msgs::action::TeachMode> {
  CommandTraits traits() const override
  {
    return {.leaves_mode_active = true, .switches_hand_guiding = true};
  }

  void check(const Goal & goal, Check & check) const override { check_end_of_mode(check, goal, false); }

  Outcome run(const Goal &, Run & run) override
  {
    start_teach_mode(run).keep_on();
    return Outcome::success("the arm can be moved by hand until end_teach_mode or stop");
  }
};

UR_ROS_RTDE_EXPORT(TeachModeStart, "teach_mode_start")

}  // namespace ur_ros_rtde
